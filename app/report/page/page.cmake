# The report page: libraries from Debian's packages, found here and embedded in the program.
set(javascript_hint /usr/share/javascript)
find_file(CHART_JS chart.min.js PATHS ${javascript_hint}/chart.js NO_DEFAULT_PATH REQUIRED)       # libjs-chart.js
find_file(THREE_JS three.min.js PATHS ${javascript_hint}/three NO_DEFAULT_PATH REQUIRED)          # libjs-three
find_file(ORBIT_JS OrbitControls.js PATHS ${javascript_hint}/three/examples/js/controls NO_DEFAULT_PATH REQUIRED)

set(PAGE ${PROJECT_BINARY_DIR}/template.html)
file(GLOB page_parts CONFIGURE_DEPENDS app/report/page/*.js app/report/page/*.css app/report/page/*.html)
add_custom_command(
  OUTPUT ${PAGE}
  COMMAND ${CMAKE_COMMAND} -DOUT=${PAGE} -DCHART=${CHART_JS} -DTHREE=${THREE_JS} -DORBIT=${ORBIT_JS}
          -P ${PROJECT_SOURCE_DIR}/app/report/page/assemble.cmake
  DEPENDS ${page_parts} app/report/page/assemble.cmake ${CHART_JS} ${THREE_JS} ${ORBIT_JS})
configure_file(app/report/page/template.cc.in template.cc @ONLY)
set_source_files_properties(${PROJECT_BINARY_DIR}/template.cc PROPERTIES
  OBJECT_DEPENDS ${PAGE} SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
target_sources(selfcal_app PRIVATE ${PROJECT_BINARY_DIR}/template.cc)
