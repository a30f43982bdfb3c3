// Which parameters the robot uses: those of the factory, or of an accepted session.
#pragma once

#include <memory>
#include <string>

#include "io/result.h"
#include "io/store/store.h"
#include "kinematics/robot.h"

namespace selfcal {

class Models {
 public:
  /// Reads the slots. Parameters of another robot (another model hash), or that cannot be read, are
  /// not used: `refused` says so and the factory's are active. It also says that parameters were
  /// lost with a damaged store or slot, until others are accepted.
  static Result<Models> load(std::shared_ptr<const Robot> factory, Store& store);

  const std::shared_ptr<const Robot>& factory() const { return factory_; }
  const std::shared_ptr<const Robot>& active() const { return active_; }
  std::int64_t session() const {
    return session_;
  }  ///< behind the active ones; 0 for the factory's
  std::int64_t since_ms() const { return since_ms_; }
  bool candidate() const { return candidate_; }
  const std::string& hash() const { return hash_; }
  const std::string& refused() const { return refused_; }
  std::string name() const;  ///< "factory" or "session 12"

  /// Puts the active robot's file where its owner's programs read it, whole or not at all. While
  /// something is refused, a file that says otherwise is kept as active.robot.yaml.before.
  Result<void> write_active(const std::filesystem::path& folder) const;

 private:
  std::shared_ptr<const Robot> factory_, active_;
  std::int64_t session_ = 0, since_ms_ = 0;
  bool candidate_ = false;
  std::string hash_, refused_;
};

}  // namespace selfcal
