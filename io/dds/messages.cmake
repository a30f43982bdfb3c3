# Library selfcal_messages: the C types of the messages in io/dds/msg, and <selfcal_messages/types.h>.
# A new .msg file there is all that a new message needs.
include(GNUInstallDirs)
find_program(IDLC idlc REQUIRED)

add_executable(selfcal_generate
  io/dds/generate/main.cc io/dds/generate/interface_text.cc io/dds/generate/message_file.cc
  io/dds/generate/type_hash.cc)
target_include_directories(selfcal_generate PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(selfcal_generate PRIVATE tl::expected Eigen3::Eigen OpenSSL::Crypto)

set(message_folder ${PROJECT_SOURCE_DIR}/io/dds/msg)
set(generated ${PROJECT_BINARY_DIR}/messages)
file(GLOB message_files RELATIVE ${message_folder} CONFIGURE_DEPENDS ${message_folder}/*/*.msg)

set(stems ${message_files})
list(TRANSFORM stems REPLACE "^([^/]+)/(.+)\\.msg$" "${generated}/\\1/msg/\\2")
set(idl_files ${stems})
list(TRANSFORM idl_files APPEND .idl)
set(message_paths ${message_files})
list(TRANSFORM message_paths PREPEND ${message_folder}/)
add_custom_command(
  OUTPUT ${idl_files} ${generated}/selfcal_messages/types.h
  COMMAND selfcal_generate ${message_folder} ${generated}
  DEPENDS selfcal_generate ${message_paths}
  COMMENT "Generating IDL from the .msg files" VERBATIM)

# case-sensitive: Temperature_ has a temperature_. -x final: the classic encoding, which is the one that ROS reads; -t: no type information.
set(generated_sources ${generated}/selfcal_messages/types.h)
foreach(stem IN LISTS stems)
  add_custom_command(
    OUTPUT ${stem}.c ${stem}.h
    COMMAND ${IDLC} -f case-sensitive -x final -t -I ${generated} -b ${generated} -o ${generated} ${stem}.idl
    DEPENDS ${idl_files}
    COMMENT "Compiling ${stem}.idl" VERBATIM)
  list(APPEND generated_sources ${stem}.c ${stem}.h)
endforeach()

# The services of an action, which no .msg file describes.
set(action ${PROJECT_SOURCE_DIR}/io/dds/ros/follow_joint_trajectory.idl)
add_custom_command(
  OUTPUT ${generated}/follow_joint_trajectory.c ${generated}/follow_joint_trajectory.h
  COMMAND ${IDLC} -f case-sensitive -x final -t -I ${generated} -o ${generated} ${action}
  DEPENDS ${action} ${idl_files}
  COMMENT "Compiling follow_joint_trajectory.idl" VERBATIM)
list(APPEND generated_sources ${generated}/follow_joint_trajectory.c ${generated}/follow_joint_trajectory.h)

add_library(selfcal_messages STATIC ${generated_sources})
set_target_properties(selfcal_messages PROPERTIES UNITY_BUILD OFF)
target_include_directories(selfcal_messages SYSTEM PUBLIC ${generated})
target_link_libraries(selfcal_messages PUBLIC CycloneDDS::ddsc)
# What others generate is held to their warnings, not to ours.
set_target_properties(selfcal_messages PROPERTIES COMPILE_OPTIONS "" COMPILE_WARNING_AS_ERROR OFF)

# As a package of ROS 2, for the src of a workspace.
set(messages_package ${CMAKE_INSTALL_DATADIR}/selfcal_msgs)
install(DIRECTORY ${message_folder}/selfcal_msgs/ DESTINATION ${messages_package}/msg COMPONENT messages
        FILES_MATCHING PATTERN "*.msg")
install(FILES ${message_folder}/selfcal_msgs/package.xml ${message_folder}/selfcal_msgs/CMakeLists.txt
        DESTINATION ${messages_package} COMPONENT messages)
