# The library for other programs: what is installed of it, and selfcal::selfcal for find_package(selfcal).
include(CMakePackageConfigHelpers)

add_library(selfcal_library INTERFACE)
target_link_libraries(selfcal_library INTERFACE selfcal_diagnosis selfcal_files)
# Eigen aligns by what the processor may do: a program built for a newer one has to align as we did.
target_compile_definitions(selfcal_library INTERFACE EIGEN_MAX_ALIGN_BYTES=16)

set(parts kinematics constraints diagnosis files library)
foreach(part IN LISTS parts)
  set_target_properties(selfcal_${part} PROPERTIES EXPORT_NAME ${part})
endforeach()
set_target_properties(selfcal_library PROPERTIES EXPORT_NAME selfcal)
target_compile_features(selfcal_library INTERFACE cxx_std_20)
list(TRANSFORM parts PREPEND selfcal_)

# Headers include each other from their folders' root ("constraints/methods/data_set.h"), programs <selfcal/selfcal.h>.
set(headers ${CMAKE_INSTALL_INCLUDEDIR}/selfcal)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/selfcal)
install(TARGETS ${parts} EXPORT selfcal ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        COMPONENT library INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${headers})
install(FILES app/selfcal.h DESTINATION ${headers} COMPONENT library)
install(DIRECTORY kinematics constraints diagnosis DESTINATION ${headers} COMPONENT library
        FILES_MATCHING PATTERN "*.h")
install(DIRECTORY io/files DESTINATION ${headers}/io COMPONENT library FILES_MATCHING PATTERN "*.h")
install(FILES io/result.h DESTINATION ${headers}/io COMPONENT library)

install(EXPORT selfcal NAMESPACE selfcal:: FILE selfcalTargets.cmake DESTINATION ${package}
        COMPONENT library)
write_basic_package_version_file(selfcalConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES app/selfcalConfig.cmake io/files/libcsv.cmake ${PROJECT_BINARY_DIR}/selfcalConfigVersion.cmake
        DESTINATION ${package} COMPONENT library)
