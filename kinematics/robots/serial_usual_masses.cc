// A usual distribution of a robot's mass along its links, where the file gives the whole of it
// only:
//   the pedestal (all that does not move) 0.15 of it;
//   moving link k of the rest in proportion to 0.65^(k - 1) (L_k + 0.15 L),
// L_k from its own origin to the next moving one's, L their sum: links that carry more and longer
// ones are heavier. Each with its centre halfway to the next one; 0.3 of the payload at the tip.
// Within a factor of two of the published links of UR10, Panda, PUMA 560: an order of size, no
// more.
#include <cmath>

#include "kinematics/robots/serial.h"

namespace selfcal::serial {
namespace {

constexpr double kPedestal = 0.15, kLighter = 0.65, kStout = 0.15, kOfPayload = 0.3;

/// Of each moving frame, the next moving one's origin (of the last one the tip) in its axes, every
/// reading zero.
std::vector<Eigen::Vector3d> next_origins(const Model& model, const std::vector<int>& moving) {
  std::vector<Eigen::Vector3d> list;
  for (size_t j = 0; j < moving.size(); ++j) {
    const bool last = j + 1 == moving.size();
    const int end = last ? static_cast<int>(model.frames.size()) - 1 : moving[j + 1];
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (int i = moving[j] + 1; i <= end; ++i) T = T * pose_in_parent(model.frames[i], 0);
    list.push_back(T.translation());
  }
  return list;
}

}  // namespace

Model with_usual_masses(Model model) {
  bool silent = true;
  for (const Frame& frame : model.frames) silent = silent && !frame.mass;
  if (!silent || !model.mass) return model;
  const std::vector<int> moving = moving_frames(model);
  const std::vector<Eigen::Vector3d> next = next_origins(model, moving);
  double reach = 0, sum = 0;
  for (size_t j = 0; j + 1 < next.size(); ++j) reach += next[j].norm();
  std::vector<double> share;
  for (size_t j = 0; j < next.size(); ++j) {
    // What hangs on the last one is the tool, which is no part of the robot's mass.
    const double length = j + 1 < next.size() ? next[j].norm() : 0;
    share.push_back(std::pow(kLighter, static_cast<double>(j)) *
                    (length + kStout * (reach > 0 ? reach : 1)));
    sum += share.back();
  }
  for (size_t j = 0; j < next.size(); ++j) {
    Frame& frame = model.frames[moving[j]];
    frame.mass = (1 - kPedestal) * *model.mass * share[j] / sum;
    if (j + 1 < next.size()) frame.com = next[j] / 2;
  }
  Frame& tip = model.frames.back();
  if (model.payload > 0 && tip.motion == Motion::fixed) tip.mass = kOfPayload * model.payload;
  return model;
}

}  // namespace selfcal::serial
