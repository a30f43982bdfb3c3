# Target csv: libcsv, which brings no CMake file of its own. Read by the build, and by programs that use
# the installed library.
find_path(CSV_INCLUDE_DIR csv.h)
find_library(CSV_LIBRARY csv)
if(CSV_INCLUDE_DIR AND CSV_LIBRARY AND NOT TARGET csv)
  add_library(csv UNKNOWN IMPORTED)
  set_target_properties(csv PROPERTIES IMPORTED_LOCATION ${CSV_LIBRARY}
                                       INTERFACE_INCLUDE_DIRECTORIES ${CSV_INCLUDE_DIR})
endif()
