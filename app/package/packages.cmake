# The Debian packages: cpack -G DEB in the build folder. Files come by the COMPONENT of their install rule.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME selfcal)
set(CPACK_PACKAGE_VENDOR selfcal)
set(CPACK_PACKAGE_CONTACT "selfcal developers <selfcal@example.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/open_folders.cmake)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program library messages)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(package_folder ${CMAKE_CURRENT_LIST_DIR})

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME selfcal)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# One thread is what it uses: the variant of OpenBLAS without others is taken where there is none yet.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "adduser, libopenblas0-serial | libopenblas0")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA
    "${package_folder}/postinst;${package_folder}/prerm;${package_folder}/postrm")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "autonomous self-calibration of robots
Visits configurations, decides which geometric parameters the touches can
tell, identifies them on board, judges the result on rows that it has not
used, and publishes it over DDS. Says where model and machine differ, and
why.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libselfcal-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
string(JOIN ", " CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS libeigen3-dev libhwy-dev libopenblas-serial-dev
       libexpected-dev nlohmann-json3-dev libyaml-cpp-dev libcsv-dev libssl-dev pkg-config)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "self-calibration of robots as a library
Kinematics, identification and diagnosis, and the files of data sets and
robots, for C++ programs that find it by CMake's find_package(selfcal).")

set(CPACK_DEBIAN_MESSAGES_PACKAGE_NAME selfcal-msgs)
set(CPACK_DEBIAN_MESSAGES_PACKAGE_SECTION science)
set(CPACK_DEBIAN_MESSAGES_PACKAGE_ARCHITECTURE all)
set(CPACK_COMPONENT_MESSAGES_DESCRIPTION "messages of the self-calibration of robots, for ROS 2
The folder /usr/share/selfcal_msgs is a package for a workspace of colcon.")

# FILE, compressed without a time, as NAME.gz in the build folder.
function(compress file name)
  configure_file(${file} ${PROJECT_BINARY_DIR}/${name} COPYONLY)
  execute_process(COMMAND gzip -9 -n -f -k ${PROJECT_BINARY_DIR}/${name} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
foreach(page selfcal.1 selfcal-data.5 selfcal-config.5)
  compress(${PROJECT_SOURCE_DIR}/app/${page} ${page})
  string(REGEX MATCH "[0-9]$" section ${page})
  install(FILES ${PROJECT_BINARY_DIR}/${page}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section} COMPONENT program)
endforeach()

# Each package says its licences and what changed.
compress(${PROJECT_SOURCE_DIR}/CHANGELOG.md changelog)
file(WRITE ${PROJECT_BINARY_DIR}/changelog.of_package
  "selfcal (${PROJECT_VERSION}-1) unstable; urgency=medium\n\n  * Release ${PROJECT_VERSION}: see changelog.gz.\n\n"
  " -- selfcal developers <selfcal@example.org>  Thu, 01 Jan 2026 00:00:00 +0000\n")
compress(${PROJECT_BINARY_DIR}/changelog.of_package changelog.Debian)
function(document component package)
  install(FILES ${package_folder}/copyright ${PROJECT_BINARY_DIR}/changelog.gz
                ${PROJECT_BINARY_DIR}/changelog.Debian.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
  file(WRITE ${PROJECT_BINARY_DIR}/${package}.lintian
    "# No upload to Debian: there is no request for a package that it could close.\n"
    "${package}: initial-upload-closes-no-bugs *\n")
  install(FILES ${PROJECT_BINARY_DIR}/${package}.lintian RENAME ${package}
          DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT ${component})
endfunction()
document(program selfcal)
document(library libselfcal-dev)
document(messages selfcal-msgs)

include(CPack)
