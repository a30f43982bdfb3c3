#include "app/service/models.h"

#include "io/file.h"
#include "io/robot_file.h"

namespace selfcal {

Result<Models> Models::load(std::shared_ptr<const Robot> factory, Store& store) {
  Models models;
  models.factory_ = models.active_ = std::move(factory);
  models.hash_ = model_hash(*models.factory_);
  const auto slot = store.slot(Slot::active);
  if (!slot) return tl::unexpected(slot.error());
  const auto candidate = store.slot(Slot::candidate);
  if (!candidate) return tl::unexpected(candidate.error());
  models.candidate_ = candidate->has_value() && (*candidate)->model_hash == models.hash_;
  if (!*slot) return models;
  const SlotRecord& record = **slot;
  if (record.session == 0) return models;
  if (record.model_hash != models.hash_) {
    models.refused_ = "the stored parameters belong to another robot (" +
                      record.model_hash.substr(0, 15) + "…, not " + models.hash_.substr(0, 15) +
                      "…): the factory's are used";
    return models;
  }
  auto robot = robot_of(record.robot_text, "active parameters");
  if (!robot) {
    models.refused_ = robot.error().what + ": the factory's are used";
    return models;
  }
  // The maker's file as it is today (limits, tolerances), with the values of the slot.
  Problems problems;
  models.active_ = make_robot(models.factory_->describe(values(**robot)), problems);
  if (problems.any()) return bad_input(problems);
  models.session_ = record.session;
  models.since_ms_ = record.since_ms;
  return models;
}

std::string Models::name() const {
  return session_ == 0 ? "factory" : "session " + std::to_string(session_);
}

Result<void> Models::write_active(const std::filesystem::path& folder) const {
  return write_file_atomically(folder / "active.robot.yaml",
                               robot_text(*active_, values(*active_)));
}

}  // namespace selfcal
