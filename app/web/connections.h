// The connections that are open, of which only so many may be.
//
// One that comes when all slots are taken pushes out the one that has kept us waiting longest: a
// crowd of slow or silent ones takes no slot from those who ask and read.
#pragma once

#include <chrono>
#include <list>
#include <mutex>

namespace selfcal {

class Connections {
 public:
  using Clock = std::chrono::steady_clock;

  /// One of the connections that are served at once, given back with its ticket.
  class Slot {
   public:
    Slot(Slot&& other) noexcept;
    Slot& operator=(Slot&&) = delete;
    ~Slot();
    /// From now on we wait for the peer, or it for us.
    void waits();
    void works();

   private:
    friend class Connections;
    struct Entry {
      int socket = -1;
      bool waiting = true;
      Clock::time_point since;
    };
    Slot(Connections& connections, std::list<Entry>::iterator entry)
        : connections_(&connections), entry_(entry) {}
    Connections* connections_;
    std::list<Entry>::iterator entry_;
  };

  /// Notes `socket`, which must stay open while the slot is held.
  Slot enter(int socket);
  /// Cuts off the connection that has been waited for longest; false when none is waited for.
  bool push_one_out();
  /// Cuts off all.
  void cut_off();

 private:
  mutable std::mutex mutex_;
  std::list<Slot::Entry> entries_;
};

}  // namespace selfcal
