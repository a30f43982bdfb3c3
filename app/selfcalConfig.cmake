# find_package(selfcal): the target selfcal::selfcal and what it links to.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4)
find_dependency(PkgConfig)
pkg_check_modules(HWY REQUIRED libhwy)
pkg_check_modules(OPENBLAS REQUIRED IMPORTED_TARGET openblas)
find_dependency(tl-expected)
find_dependency(nlohmann_json)
find_dependency(yaml-cpp)
find_dependency(OpenSSL COMPONENTS Crypto)

include(${CMAKE_CURRENT_LIST_DIR}/libcsv.cmake)
if(NOT TARGET csv)
  set(selfcal_FOUND FALSE)
  set(selfcal_NOT_FOUND_MESSAGE "libcsv is missing (libcsv-dev)")
  return()
endif()

include(${CMAKE_CURRENT_LIST_DIR}/selfcalTargets.cmake)
