// Encoders on a CAN bus, as CONFIG.yaml describes them.

#include "io/can/settings.h"

#include <algorithm>
#include <optional>

#include "io/can/joint_fields.h"

namespace selfcal {
namespace {

// IFNAMSIZ of the kernel, its closing zero aside.
constexpr std::size_t kMostName = 15;
// CiA 301: SYNC's predefined id.
constexpr CanId kSync = {.value = 0x80, .extended = false};

class CanSettingsReader {
 public:
  CanSettingsReader(const Node& node, Problems& problems)
      : f_(node, "encoders on CAN", problems), problems_(problems) {}

  CanSettings read(const std::vector<Joint>& joints, const std::filesystem::path& folder) {
    s_.interface = f_.text("interface");
    if (f_.has("interface") && (s_.interface.empty() || s_.interface.size() > kMostName))
      f_.fail("interface", "a name of 1 to 15 characters");
    read_dbc_file(folder);
    read_joints(joints);
    read_sync();
    read_timing();
    f_.refuse_unknown();
    if (problems_.any()) return std::move(s_);
    if (const auto wrong = s_.map.finish()) problems_.add(f_.place(), f_.what() + ": " + *wrong);
    return std::move(s_);
  }

 private:
  void read_dbc_file(const std::filesystem::path& folder) {
    const std::string name = f_.text("dbc", "");
    if (name.empty()) return;
    auto dbc = read_dbc(folder / name);
    if (dbc)
      dbc_ = *std::move(dbc);
    else
      problems_.list.push_back(dbc.error().what);
  }

  void read_joints(const std::vector<Joint>& robot) {
    const Node* entries = f_.node("joints");
    if (!entries || entries->kind != Node::Kind::map)
      return f_.fail("joints", "an entry for each joint, as `NAME: {...}`");
    Fields joints(*entries, f_.what() + " joints", problems_);
    for (const Joint& joint : robot) {
      const Node* entry = joints.node(joint.name);
      if (!entry) {
        joints.fail(joint.name, "where its count stands");
        continue;
      }
      s_.map.joints.push_back(read_can_joint(*entry, joint.name, joint.quantity,
                                             dbc_ ? &*dbc_ : nullptr, cia402_, problems_));
    }
    joints.refuse_unknown();
  }

  void read_sync() {
    const Node* node = f_.node("sync");
    if (!node) {
      if (cia402_ && !f_.has("cycle")) s_.map.sync = kSync;
      return;
    }
    Fields sync(*node, f_.what() + " sync", problems_);
    s_.map.sync = read_can_id(sync, kSync);
    if (sync.has("send_period")) s_.sync_send_period = sync.number("send_period", 0.01, 5e-4, 1);
    sync.refuse_unknown();
  }

  void read_timing() {
    CanTiming& t = s_.timing;
    if (s_.map.sync) {
      if (f_.has("cycle")) f_.fail("cycle", "only without 'sync'");
      t.window = f_.number("window", 5e-3, 1e-4, 1);
    } else {
      if (!f_.has("cycle")) f_.fail("cycle", "the time between two frames of a joint (s)");
      t.cycle = f_.number("cycle", 0.01, 1e-4, 1);
      t.window = f_.number("window", 1.6 * t.cycle, t.cycle, 10 * t.cycle);
    }
    t.delay = f_.number("delay", 0, 0, 0.1);
  }

  Fields f_;
  Problems& problems_;
  CanSettings s_;
  std::optional<Dbc> dbc_;
  bool cia402_ = false;
};

}  // namespace

CanSettings read_can_settings(const Node& node, const std::vector<Joint>& joints,
                              const std::filesystem::path& folder, Problems& problems) {
  return CanSettingsReader(node, problems).read(joints, folder);
}

}  // namespace selfcal
