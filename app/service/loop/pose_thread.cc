#include "app/service/loop/pose_thread.h"

#include <exception>

namespace selfcal {

Result<std::unique_ptr<PoseThread>> PoseThread::open(const DdsParticipant& participant,
                                                     const std::string& robot,
                                                     const Models& models) {
  std::unique_ptr<PoseThread> made(new PoseThread);
  auto poses = DdsPoses::open(participant, robot, made->wakeup_);
  if (!poses) return tl::unexpected(poses.error());
  made->poses_ = *std::move(poses);
  made->use(models);
  made->thread_ = std::thread([thread = made.get()] { thread->work(); });
  return made;
}

PoseThread::~PoseThread() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wakeup_.notify();
  if (thread_.joinable()) thread_.join();
}

void PoseThread::use(const Models& models) {
  const std::lock_guard lock(mutex_);
  if (active_ == models.active()) return;
  factory_ = models.factory();
  active_ = models.active();
  name_ = models.name();
}

void PoseThread::work() {
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      if (ending_) return;
    }
    const bool answered =
        poses_->answer([this](const PoseRequestMessage& request) { return answer(request); });
    if (!answered) wakeup_.wait(kSecond);
  }
}

PoseReplyMessage PoseThread::answer(const PoseRequestMessage& request) {
  std::unique_lock lock(mutex_);
  const auto factory = factory_, active = active_;
  const std::string name = name_;
  lock.unlock();
  try {
    return answers_.answer(request, factory, active, name);
  } catch (const std::exception& error) {  // out of memory, or a bug that must not end the service
    PoseReplyMessage refused;
    refused.status = "refused";
    refused.why = error.what();
    return refused;
  }
}

}  // namespace selfcal
