// Between the plain structs and the generated C structs.
//
// borrow() makes a C struct whose strings and sequences are those of its argument: nothing is
// copied or freed, and the argument must outlive it. to_plain() copies what a reader lends.
#pragma once

#include <string>
#include <vector>

#include <selfcal_messages/types.h>

#include "io/messages.h"
#include "io/ports.h"

namespace selfcal {

dds::Time time_of(Nanoseconds t);  ///< of any clock, before its epoch too
Nanoseconds nanoseconds(const dds::Time& time);
dds::Header header_of(Nanoseconds stamp);  ///< of no frame

dds::Status borrow(const StatusMessage& status);
dds::Progress borrow(const ProgressMessage& progress);
dds::Result borrow(const ResultMessage& result);
dds::Command borrow(const CommandMessage& command);
dds::CommandReply borrow(const CommandReplyMessage& reply);
dds::MotionReply borrow(const MotionReply& reply);
dds::MotionRequest borrow(const MotionRequest& request);
dds::MotionRequest borrow_stop(std::uint64_t id, const std::string& why);

StatusMessage to_plain(const dds::Status& status);
ProgressMessage to_plain(const dds::Progress& progress);
ResultMessage to_plain(const dds::Result& result);
CommandMessage to_plain(const dds::Command& command);
CommandReplyMessage to_plain(const dds::CommandReply& reply);
/// An outcome that is not known becomes a refusal that says so.
MotionReply to_plain(const dds::MotionReply& reply);
/// Fails when its kind is not known.
Result<RobotRequest> to_plain(const dds::MotionRequest& request);

/// Health of a robot as a DiagnosticArray: names as "ROBOT/NAME". Holds copies of its own.
class DiagnosticsToSend {
 public:
  DiagnosticsToSend(const std::vector<HealthMessage>& health, const std::string& robot,
                    const std::string& hardware_id, std::int64_t unix_ms);
  DiagnosticsToSend(const DiagnosticsToSend&) = delete;
  DiagnosticsToSend& operator=(const DiagnosticsToSend&) = delete;
  const dds::DiagnosticArray& message() const { return message_; }

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<dds::KeyValue>> values_;
  std::vector<dds::DiagnosticStatus> lines_;
  dds::DiagnosticArray message_{};
};

/// The lines of `robot`, with their names as they were before they were sent; none when the message
/// is of something else.
HealthReport to_plain(const dds::DiagnosticArray& array, const std::string& robot);

namespace borrowed {

/// The string without its constness, which the generated structs lack; nobody writes to it.
inline char* text(const std::string& s) { return const_cast<char*>(s.c_str()); }

}  // namespace borrowed

}  // namespace selfcal
