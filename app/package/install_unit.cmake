# The systemd unit, which starts the program where it is installed, whatever prefix that is.
file(READ ${CMAKE_CURRENT_LIST_DIR}/../selfcal.service unit)
string(REPLACE /usr/bin/selfcal ${CMAKE_INSTALL_PREFIX}/bin/selfcal unit "${unit}")
set(place $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/lib/systemd/system/selfcal.service)
message(STATUS "Installing: ${place}")
file(WRITE ${place} "${unit}")
file(CHMOD ${place} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
