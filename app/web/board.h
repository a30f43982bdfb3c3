// What the page shows, by robot and part, as JSON; only what has changed goes to a page again.
//
// Watchers put, servers read, from any threads.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "io/files/json_parts.h"

namespace selfcal {

class Board {
 public:
  /// `epoch` tells this board from one of before: a page that asks with another gets everything.
  explicit Board(std::string epoch) : epoch_(std::move(epoch)) {}

  /// The robot's part is `value` from now on. The robot "" stands for the whole domain.
  void put(const std::string& robot, const std::string& part, const Json& value);
  /// Adds to the robot's list, which keeps its last `most`.
  void append(const std::string& robot, const std::string& list, const Json& value,
              std::size_t most);
  /// Empties the list.
  void restart(const std::string& robot, const std::string& list);
  /// Forgets the robot.
  void drop(const std::string& robot);

  /// The part, if the robot has it.
  std::optional<Json> part(const std::string& robot, const std::string& part) const;

  /// {"epoch", "version", "robot", "domain": {PART: …}, "parts": {PART: …}, "lists": {LIST:
  /// {"restarted": …, "items": […]}}} with what has changed since `version` of `epoch`. Of a robot
  /// that is not here, "known" is false.
  std::string changes(const std::string& robot, const std::string& epoch,
                      std::uint64_t version) const;

 private:
  struct Text {
    std::uint64_t version = 0;
    std::string json;
  };
  struct List {
    std::uint64_t restarted = 0;
    std::deque<Text> items;
  };
  struct Topic {
    std::map<std::string, Text> parts;
    std::map<std::string, List> lists;
  };
  static std::string parts_since(const Topic& topic, std::uint64_t version);
  static std::string lists_since(const Topic& topic, std::uint64_t version);

  std::string epoch_;
  mutable std::mutex mutex_;
  std::uint64_t version_ = 0;
  std::map<std::string, Topic> topics_;
};

}  // namespace selfcal
