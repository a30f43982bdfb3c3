// How surely and for how long messages are kept, by what they are for.
#pragma once

#include <dds/dds.h>

#include <memory>

#include "io/wakeup.h"

namespace selfcal {

/// A write that finds no room waits this long and then fails.
inline constexpr Nanoseconds kLongestBlocking = 100 * kMillisecond;
/// Room of a writer or reader that keeps all.
inline constexpr int kMostKept = 256;

struct DdsQos {
  bool reliable = true;
  bool transient_local = false;  ///< a late reader gets the last `depth`
  int depth = 1;                 ///< messages kept; 0: all, up to kMostKept
};

/// Status and result: the last is for whoever comes late.
inline constexpr DdsQos kLatched{.transient_local = true};
/// A watcher of the same: all of those that come while it looks elsewhere.
inline constexpr DdsQos kLatchedReader{.transient_local = true, .depth = 64};
inline constexpr DdsQos kProgress{.depth = 10};
inline constexpr DdsQos kDiagnostics{.depth = 10};
/// Commands, and what a robot is asked as it hears it: none may be lost without the sender's
/// knowing.
inline constexpr DdsQos kExchange{.depth = 0};
/// The service's readers of the same: the library receives everything in one thread, the touch
/// among it, which a reader without room holds up; so the oldest makes room.
inline constexpr DdsQos kExchangeReader{.depth = kMostKept};
/// Poses that somebody asks for.
inline constexpr DdsQos kPoseReader{.depth = 64};
/// What the service asks of a robot: a stop never waits for a reader that has stopped reading.
inline constexpr DdsQos kMotion{.depth = 16};
/// Replies to commands: nor does the loop wait for who asks and does not listen.
inline constexpr DdsQos kReplies{.depth = 64};
/// From a robot: reliable to send and best effort to receive, so that publishers of both kinds
/// are heard and readers of both kinds hear.
inline constexpr DdsQos kSensorWriter{.depth = 10};
inline constexpr DdsQos kSensorReader{.reliable = false, .depth = 1024};

using DdsQosHandle = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

/// The library's form, with `type_hash`, unless it is empty, as the user data by which ROS tells
/// types apart.
DdsQosHandle to_library(const DdsQos& qos, const char* type_hash);

}  // namespace selfcal
