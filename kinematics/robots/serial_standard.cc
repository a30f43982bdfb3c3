// Standard DH regrouped into modified frames. alpha and d act along one x axis and commute, so that
//   Rz(t1) Tz(r1) Tx(d1) Rx(a1) Rz(t2) Tz(r2) Tx(d2) Rx(a2) =
//   [Rz(t1) Tz(r1)] [Rx(a1) Tx(d1) Rz(t2) Tz(r2)] [Rx(a2) Tx(d2)]
// A centre of mass c in a row's frame is at (d, 0, 0) + Rx(alpha) c in ours, which ends before
// alpha and d.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "kinematics/robots/serial_frames.h"

namespace selfcal::serial {
namespace {

constexpr std::array<int, 2> kMoved = {kAlpha, kD};  // from a row to the frame after it

/// A frame that stays where it is.
Frame nothing() {
  Frame frame;
  frame.value = frame.nominal = Eigen::VectorXd::Zero(kFields);
  frame.tolerance = Eigen::VectorXd::Constant(kFields, -1);
  return frame;
}

class Regrouping {
 public:
  explicit Regrouping(const std::vector<Frame>& table) : table_(table) {
    for (size_t i = 0; i < table.size(); ++i)
      if (table[i].motion != Motion::fixed) last_joint_ = table[i].name;
  }

  std::vector<Frame> run() {
    for (const Frame& row : table_) {
      if (row.whole) {
        end_row();
        frames_.push_back(row);
      } else {
        add(row);
      }
    }
    end_row();
    return std::move(frames_);
  }

 private:
  void add(const Frame& row) {
    Frame frame = row;
    for (const int i : kMoved) {
      frame.value[i] = left_.value[i];
      frame.nominal[i] = left_.nominal[i];
      frame.tolerance[i] = left_.tolerance[i];
    }
    if (row.mass)
      frame.com = Eigen::Vector3d(row.value[kD], 0, 0) +
                  Eigen::AngleAxisd(row.value[kAlpha], Eigen::Vector3d::UnitX()) * row.com;
    moving_ = moving_ || row.motion != Motion::fixed;
    left_ = nothing();
    left_.name = row.name;
    for (const int i : kMoved) {
      left_.value[i] = row.value[i];
      left_.nominal[i] = row.nominal[i];
      left_.tolerance[i] = row.tolerance[i];
      // What places the robot keeps its prior where the frame after it is a link's.
      const bool is_something = row.value[i] != 0 || row.nominal[i] != 0;
      if (!moving_ && row.tolerance[i] <= 0 && is_something) left_.tolerance[i] = kPlacedTolerance;
    }
    frames_.push_back(std::move(frame));
  }

  /// What is left of the last row, unless it is nothing, as a frame of its own.
  void end_row() {
    Frame rest = std::exchange(left_, nothing());
    if (rest.value.isZero(0) && rest.nominal.isZero(0) && rest.tolerance.maxCoeff() <= 0) return;
    rest.name = free_name(rest.name == last_joint_ ? "flange" : rest.name + "_end");
    frames_.push_back(std::move(rest));
  }

  std::string free_name(std::string name) const {
    const auto taken = [&](const std::vector<Frame>& list) {
      return std::ranges::find(list, name, &Frame::name) != list.end();
    };
    while (taken(table_) || taken(frames_)) name += "_";
    return name;
  }

  const std::vector<Frame>& table_;
  std::vector<Frame> frames_;
  Frame left_ = nothing();  ///< alpha and d of the last row
  bool moving_ = false;     ///< a joint has come
  std::string last_joint_;
};

}  // namespace

std::vector<Frame> from_standard(const std::vector<Frame>& table) {
  return Regrouping(table).run();
}

}  // namespace selfcal::serial
