# Pages: libraries from Debian's packages, found here and embedded in the program.
set(javascript_hint /usr/share/javascript)
find_file(CHART_JS chart.min.js PATHS ${javascript_hint}/chart.js NO_DEFAULT_PATH REQUIRED)       # libjs-chart.js
find_file(THREE_JS three.min.js PATHS ${javascript_hint}/three NO_DEFAULT_PATH REQUIRED)          # libjs-three
find_file(ORBIT_JS OrbitControls.js PATHS ${javascript_hint}/three/examples/js/controls NO_DEFAULT_PATH REQUIRED)

# The program has the page FRAME, with the styles and scripts listed after STYLES and SCRIPTS in it, between the
# symbols selfcal_SYMBOL_begin and selfcal_SYMBOL_end. Files are named from app/.
function(selfcal_page SYMBOL FRAME)
  cmake_parse_arguments(PARSE_ARGV 2 page "" "" "STYLES;SCRIPTS")
  set(PAGE ${PROJECT_BINARY_DIR}/${SYMBOL}.html)
  set(app ${PROJECT_SOURCE_DIR}/app)
  list(TRANSFORM page_STYLES PREPEND ${app}/)
  list(TRANSFORM page_SCRIPTS PREPEND ${app}/)
  add_custom_command(
    OUTPUT ${PAGE}
    COMMAND ${CMAKE_COMMAND} -DOUT=${PAGE} -DFRAME=${app}/${FRAME} "-DSTYLES=${page_STYLES}"
            "-DSCRIPTS=${page_SCRIPTS}" -DCHART=${CHART_JS} -DTHREE=${THREE_JS} -DORBIT=${ORBIT_JS}
            -P ${app}/report/page/assemble.cmake
    DEPENDS ${app}/${FRAME} ${page_STYLES} ${page_SCRIPTS} ${app}/report/page/licences.html
            ${app}/report/page/assemble.cmake ${CHART_JS} ${THREE_JS} ${ORBIT_JS}
    VERBATIM)
  configure_file(app/report/page/template.cc.in ${SYMBOL}.cc @ONLY)
  set_source_files_properties(${PROJECT_BINARY_DIR}/${SYMBOL}.cc TARGET_DIRECTORY selfcal_app PROPERTIES
    OBJECT_DEPENDS ${PAGE} SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
  target_sources(selfcal_app PRIVATE ${PROJECT_BINARY_DIR}/${SYMBOL}.cc)
endfunction()

set(drawing report/page/units.js report/page/tables.js report/page/charts.js report/page/view3d.js)
selfcal_page(page report/page/page.html STYLES report/page/page.css
             SCRIPTS ${drawing} report/page/identification.js report/page/diagnosis.js report/page/history.js
                     report/page/page.js)
selfcal_page(live web/page/live.html STYLES report/page/page.css web/page/live.css
             SCRIPTS ${drawing} web/page/link.js web/page/live_view.js web/page/commands.js web/page/robot.js
                     web/page/fleet.js web/page/live.js)
