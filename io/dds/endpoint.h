// Typed writers and readers of topics.
//
// Every endpoint carries its type's ROS hash as user data, which newer ROS distributions look for.
// A write never waits longer than kLongestBlocking; nothing else here waits at all.
#pragma once

#include <dds/dds.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <selfcal_messages/types.h>

#include "io/clock.h"
#include "io/dds/entity.h"
#include "io/dds/participant.h"
#include "io/dds/qos.h"
#include "io/result.h"
#include "io/wakeup.h"

namespace selfcal {

/// What a reader's listener notes of messages that come.
struct DdsArrivals {
  Wakeup* wakeup = nullptr;            ///< hears of messages and of peers; may be null
  std::atomic<std::uint64_t> count{};  ///< messages since the start
  std::atomic<Nanoseconds> last{};     ///< our time of the newest
};

Result<DdsEntity> open_writer(const DdsParticipant& participant, const std::string& topic,
                              const dds::MessageType& type, const DdsQos& qos, Wakeup* wakeup);
/// A reader, gone before what its listener notes.
struct DdsListening {
  DdsArrivals arrivals;
  DdsEntity entity;
};
Result<std::unique_ptr<DdsListening>> open_reader(const DdsParticipant& participant,
                                                  const std::string& topic,
                                                  const dds::MessageType& type, const DdsQos& qos,
                                                  Wakeup* wakeup);
Result<void> write(dds_entity_t writer, const void* message);
std::uint64_t lost_on_the_way(dds_entity_t reader);
inline constexpr std::size_t kMostWriters = 64;
std::vector<dds_instance_handle_t> writers_heard(dds_entity_t reader);

/// Sends messages of the generated type T.
template <class T>
class DdsWriter {
 public:
  DdsWriter() = default;
  /// `wakeup`, when there is one, hears of readers that come and go.
  static Result<DdsWriter> open(const DdsParticipant& participant, const std::string& topic,
                                const DdsQos& qos, Wakeup* wakeup = nullptr) {
    return open_writer(participant, topic, dds::message_type<T>, qos, wakeup)
        .map([](DdsEntity entity) { return DdsWriter(std::move(entity)); });
  }
  Result<void> write(const T& message) { return selfcal::write(entity_.handle(), &message); }
  /// Readers that hear us.
  int matched() const {
    dds_publication_matched_status_t status{};
    dds_get_publication_matched_status(entity_.handle(), &status);
    return static_cast<int>(status.current_count);
  }
  dds_entity_t handle() const { return entity_.handle(); }

 private:
  explicit DdsWriter(DdsEntity entity) : entity_(std::move(entity)) {}
  DdsEntity entity_;
};

/// Takes messages of the generated type T.
template <class T>
class DdsReader {
 public:
  DdsReader() = default;
  /// `wakeup`, when there is one, hears of messages and of writers that come and go.
  static Result<DdsReader> open(const DdsParticipant& participant, const std::string& topic,
                                const DdsQos& qos, Wakeup* wakeup = nullptr) {
    return open_reader(participant, topic, dds::message_type<T>, qos, wakeup)
        .map([](std::unique_ptr<DdsListening> listening) {
          return DdsReader(std::move(listening));
        });
  }

  /// Calls `use(const T&)` for each message that has come, oldest first, at most `most`; the
  /// message is gone when `use` returns. Of `use(const T&, dds_instance_handle_t)` the second is
  /// who wrote it.
  template <class Use>
  Result<void> take(std::size_t most, Use use);
  /// All that have come, up to what a reader keeps at most.
  template <class Use>
  Result<void> take(Use use) {
    return take(4096, std::move(use));
  }

  /// Writers that we hear.
  int matched() const {
    dds_subscription_matched_status_t status{};
    dds_get_subscription_matched_status(handle(), &status);
    return static_cast<int>(status.current_count);
  }
  /// The writers that we hear, at most kMostWriters of them.
  std::vector<dds_instance_handle_t> writers() const { return writers_heard(handle()); }
  /// Messages that never came, and those that came and were pushed out before they were taken.
  /// The latter are seen at the next take.
  std::uint64_t lost() const { return lost_on_the_way(handle()) + pushed_out_; }
  /// Our time of the newest message taken.
  Nanoseconds newest_arrival() const { return newest_arrival_; }
  dds_entity_t handle() const { return listening_->entity.handle(); }

 private:
  explicit DdsReader(std::unique_ptr<DdsListening> listening) : listening_(std::move(listening)) {}
  void note_taken(std::uint64_t arrived, std::size_t taken, bool all);
  template <class Use>
  static void hand_over(Use& use, const T& message, const dds_sample_info_t& info) {
    if constexpr (std::is_invocable_v<Use&, const T&, dds_instance_handle_t>)
      use(message, info.publication_handle);
    else if constexpr (std::is_invocable_v<Use&, const T&, const dds_sample_info_t&>)
      use(message, info);
    else
      use(message);
  }

  std::unique_ptr<DdsListening> listening_;
  std::uint64_t taken_ = 0;
  std::uint64_t pushed_out_ = 0;
  Nanoseconds newest_arrival_ = 0;
};

template <class T>
template <class Use>
Result<void> DdsReader<T>::take(std::size_t most, Use use) {
  constexpr std::size_t kBatch = 64;
  std::array<dds_sample_info_t, kBatch> infos;
  const std::uint64_t arrived = listening_->arrivals.count.load(std::memory_order_acquire);
  std::size_t taken = 0;
  bool all = false;
  while (!all && taken < most) {
    std::array<void*, kBatch> messages{};  // null: the library lends its own
    const auto size = std::min(kBatch, most - taken);
    const dds_return_t count =
        dds_take(handle(), messages.data(), infos.data(), size, static_cast<std::uint32_t>(size));
    if (count < 0) return dds_failed("messages cannot be read", count);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      if (infos[i].valid_data) hand_over(use, *static_cast<const T*>(messages[i]), infos[i]);
    if (count > 0) dds_return_loan(handle(), messages.data(), count);
    taken += static_cast<std::size_t>(count);
    all = static_cast<std::size_t>(count) < size;
  }
  note_taken(arrived, taken, all);
  return {};
}

// `arrived` had come before the first was taken: what is not among the taken was pushed out.
template <class T>
void DdsReader<T>::note_taken(std::uint64_t arrived, std::size_t taken, bool all) {
  taken_ += taken;
  if (all && arrived > taken_) pushed_out_ = std::max(pushed_out_, arrived - taken_);
  if (taken == 0) return;
  // The listener runs just after a message can be taken, and may not have noted this one yet.
  const Nanoseconds last = listening_->arrivals.last.load(std::memory_order_acquire);
  newest_arrival_ = last > newest_arrival_ ? last : monotonic_now();
}

}  // namespace selfcal
