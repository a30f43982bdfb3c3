// What topics are called, so that ROS 2 reads them: topic /foo of ROS is topic rt/foo of DDS.
#pragma once

#include <string>
#include <string_view>

namespace selfcal {

/// A robot's id as a part of a ROS name: lower case letters, digits and single underscores, which
/// stand for everything else; starts with a letter and ends with no underscore. "RX-90 #2" becomes
/// "rx_90_2", "6-axis" becomes "robot_6_axis" and an id without letters or digits "robot". Ids that
/// differ only in what is replaced become the same name.
std::string ros_name(std::string_view robot);

/// DDS topic of a robot's own `topic`: "rt/selfcal/ROBOT/status".
std::string robot_topic(std::string_view robot, std::string_view topic);

/// DDS topic of a ROS topic, with or without its leading slash: "joint_states" and "/joint_states"
/// are "rt/joint_states".
std::string ros_topic(std::string_view topic);

}  // namespace selfcal
