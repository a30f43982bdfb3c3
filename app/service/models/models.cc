#include "app/service/models/models.h"

#include "io/files/file.h"
#include "io/files/robot_file.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/make_robot.h"

namespace selfcal {
namespace {

constexpr std::size_t kLongestRobot = std::size_t{1} << 24;  // bytes

/// What is noted of active parameters, or of the whole store, since those that are active now came.
Result<std::string> lost(Store& store, const std::optional<SlotRecord>& active) {
  const auto notes = store.damage();
  if (!notes) return tl::unexpected(notes.error());
  for (const DamageRecord& note : *notes) {
    if (note.place == "store" && !active) return note.what;
    if (note.place == "active" && (!active || note.unix_ms >= active->since_ms))
      return note.what + " were damaged and are set aside";
  }
  return std::string();
}

}  // namespace

Result<Models> Models::load(std::shared_ptr<const Robot> factory, Store& store) {
  Models models;
  models.factory_ = models.active_ = std::move(factory);
  models.hash_ = model_hash(*models.factory_);
  const auto slot = store.slot(Slot::active);
  if (!slot) return tl::unexpected(slot.error());
  const auto candidate = store.slot(Slot::candidate);
  if (!candidate) return tl::unexpected(candidate.error());
  models.candidate_ = candidate->has_value() && (*candidate)->model_hash == models.hash_;
  const auto what = lost(store, *slot);
  if (!what) return tl::unexpected(what.error());
  const std::string before = what->empty() ? "" : *what + "; ";
  const auto refuse = [&](const std::string& why) {
    models.refused_ = why + ": the factory's are used";
    return models;
  };
  if (!*slot || (*slot)->session == 0) return what->empty() ? models : refuse(*what);
  const SlotRecord& record = **slot;
  if (record.model_hash != models.hash_)
    return refuse(before + "the stored parameters belong to another robot (" +
                  record.model_hash.substr(0, 15) + "…, not " + models.hash_.substr(0, 15) + "…)");
  auto robot = robot_of(record.robot_text, "active parameters");
  if (!robot) return refuse(before + robot.error().what);
  // The maker's file as it is today (limits, tolerances), with the values of the slot; a corrected
  // robot as it is, with the masses that its effects were found by.
  Problems problems;
  models.active_ = effects_of(**robot).empty()
                       ? make_robot(models.factory_->text().describe(values(**robot)), problems)
                       : std::move(*robot);
  if (problems.any()) return bad_input(problems);
  models.session_ = record.session;
  models.since_ms_ = record.since_ms;
  if (!what->empty())
    models.refused_ = *what + ": those before them, of " + models.name() + ", are used";
  return models;
}

std::string Models::name() const {
  return session_ == 0 ? "factory" : "session " + std::to_string(session_);
}

Result<void> Models::write_active(const std::filesystem::path& folder) const {
  const std::filesystem::path path = folder / "active.robot.yaml";
  const std::string text = robot_text(*active_, values(*active_));
  const auto there = read_file(path, kLongestRobot);
  if (there && *there == text) return {};
  if (!refused_.empty() && there)
    if (auto kept = write_file_atomically(path.string() + ".before", *there); !kept) return kept;
  return write_file_atomically(path, text);
}

}  // namespace selfcal
