// The arm among its plates as MuJoCo simulates it: where a motion meets a plate, the engine's own
// dynamics and its own detection of contacts say.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "tests/mujoco/arm.h"

namespace selfcal::mujoco {

/// A motion that is to meet a plate.
struct Approach {
  int plate = 0;
  Eigen::VectorXd q;         ///< where the tip would meet it if no joint gave way (rad)
  Eigen::VectorXd velocity;  ///< rad/s
};

/// Where it met it.
struct Touch {
  Eigen::VectorXd q, velocity;  ///< of the motors (rad, rad/s)
  Eigen::VectorXd give;         ///< of the springs (rad); 0 of rigid joints
  double seconds = 0;           ///< since the motion began
};

class Cell {
 public:
  /// `model` is what mjcf() wrote of an arm and `plates`.
  Cell(const std::filesystem::path& model, const std::vector<Plate>& plates);

  int joints() const { return static_cast<int>(motors_.size()); }

  /// A random motion to a random place of the plate, within the limits of `arm`'s joints and free
  /// of the other plates; nothing where this try led elsewhere.
  std::optional<Approach> plan(int plate, const Arm& arm, Random& random);

  /// Moves until the engine reports the contact; nothing when it does not within 12 mm.
  std::optional<Touch> touch(const Approach& approach);

  /// Derivative (m/rad) of the distance from the plate to the readings.
  Eigen::VectorXd slope(int plate, const Eigen::VectorXd& q);
  /// Of the ball from the plate (m), springs at rest.
  double distance(int plate, const Eigen::VectorXd& q);
  /// Centre of the ball (m, world), springs at rest.
  Eigen::Vector3d tip(const Eigen::VectorXd& q);

 private:
  struct ModelEnd {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
  };
  struct DataEnd {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  struct Spring {
    int joint = 0;    ///< behind this motor
    int address = 0;  ///< in qpos and qvel
  };

  void stand(const Eigen::VectorXd& q);
  void settle(const Eigen::VectorXd& q);
  void follow(const Eigen::VectorXd& q);
  Touch read() const;
  /// Distance of the contact that is reported between ball and plate.
  std::optional<double> reported(int plate) const;

  std::vector<Plate> plates_;
  std::unique_ptr<mjModel, ModelEnd> model_;
  std::unique_ptr<mjData, DataEnd> data_;
  std::vector<int> motors_;  ///< address in qpos and qvel, by joint
  std::vector<Spring> springs_;
  std::vector<int> plate_geoms_;
  int tip_geom_ = -1;
  Eigen::VectorXd lead_;  ///< of the servos over the motors that carry the arm at rest (rad)
};

}  // namespace selfcal::mujoco
