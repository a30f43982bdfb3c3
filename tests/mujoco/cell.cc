#include "tests/mujoco/cell.h"

#include <array>
#include <cmath>
#include <stdexcept>

namespace selfcal::mujoco {
namespace {

constexpr double kLead = 5e-3, kOvershoot = 7e-3;  // m, before and beyond the planned place
constexpr int kSettle = 300;                       // steps
constexpr double kClear = 0.02;                    // m, from the plates that are not meant

}  // namespace

Cell::Cell(const std::filesystem::path& model, const std::vector<Plate>& plates) : plates_(plates) {
  std::array<char, 1000> error{};
  model_.reset(mj_loadXML(model.c_str(), nullptr, error.data(), error.size()));
  if (!model_) throw std::runtime_error(error.data());
  data_.reset(mj_makeData(model_.get()));
  // A spring's hinge follows its motor's; every hinge has one place in qpos and in qvel.
  for (int i = 0; i < model_->njnt; ++i)
    if (model_->jnt_stiffness[i] > 0)
      springs_.push_back({joints() - 1, i});
    else
      motors_.push_back(i);
  for (const Plate& plate : plates_)
    plate_geoms_.push_back(mj_name2id(model_.get(), mjOBJ_GEOM, plate.name.c_str()));
  tip_geom_ = mj_name2id(model_.get(), mjOBJ_GEOM, "tip");
}

void Cell::stand(const Eigen::VectorXd& q) {
  mj_resetData(model_.get(), data_.get());
  for (int j = 0; j < joints(); ++j) data_->qpos[motors_[j]] = q[j];
  mj_kinematics(model_.get(), data_.get());
  mj_comPos(model_.get(), data_.get());
}

Eigen::Vector3d Cell::tip(const Eigen::VectorXd& q) {
  stand(q);
  return Eigen::Map<const Eigen::Vector3d>(data_->geom_xpos + 3 * tip_geom_);
}

double Cell::distance(int plate, const Eigen::VectorXd& q) {
  return plates_[plate].normal.dot(tip(q)) - plates_[plate].distance - kBall;
}

Eigen::VectorXd Cell::slope(int plate, const Eigen::VectorXd& q) {
  stand(q);
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> J(3, model_->nv);
  mj_jacGeom(model_.get(), data_.get(), J.data(), nullptr, tip_geom_);
  Eigen::VectorXd slope(joints());
  for (int j = 0; j < joints(); ++j) slope[j] = plates_[plate].normal.dot(J.col(motors_[j]));
  return slope;
}

std::optional<Approach> Cell::plan(int plate, const Arm& arm, Random& random) {
  std::vector<const ArmFrame*> limits;
  for (const ArmFrame& frame : arm.frames)
    if (frame.turns) limits.push_back(&frame);
  Approach approach{plate, Eigen::VectorXd(joints()), Eigen::VectorXd(joints())};
  for (int j = 0; j < joints(); ++j) {
    approach.q[j] = uniform(random, limits[j]->lower, limits[j]->upper);
    approach.velocity[j] = 2e-3 * normal(random);
  }
  constexpr int kSteps = 8;
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::VectorXd n = slope(plate, approach.q);
    approach.q -= distance(plate, approach.q) / std::max(n.squaredNorm(), 1e-2) * n;
  }
  for (int j = 0; j < joints(); ++j)
    if (approach.q[j] < limits[j]->lower || approach.q[j] > limits[j]->upper) return {};
  for (int other = 0; other < static_cast<int>(plates_.size()); ++other) {
    const double far = distance(other, approach.q);
    if (other == plate ? std::abs(far) > 1e-5 : far < kClear) return {};
  }
  // Towards the plate at 3 to 15 mm/s, and a little along it.
  const double speed = std::exp(uniform(random, std::log(3e-3), std::log(15e-3)));
  const Eigen::VectorXd n = slope(plate, approach.q);
  approach.velocity -= (speed + n.dot(approach.velocity)) / n.squaredNorm() * n;
  return approach;
}

/// At rest near the balance of servos, springs and gravity, then the rest by the engine itself.
void Cell::settle(const Eigen::VectorXd& q) {
  stand(q);
  mj_forward(model_.get(), data_.get());
  for (const Spring& spring : springs_)
    data_->qpos[spring.address] =
        -data_->qfrc_bias[spring.address] / model_->jnt_stiffness[spring.address];
  lead_.resize(joints());
  for (int j = 0; j < joints(); ++j)
    lead_[j] = data_->qfrc_bias[motors_[j]] / model_->actuator_gainprm[mjNGAIN * j];
  follow(q);
  for (int step = 0; step < kSettle; ++step) mj_step(model_.get(), data_.get());
  data_->time = 0;
}

void Cell::follow(const Eigen::VectorXd& q) {
  for (int j = 0; j < joints(); ++j) data_->ctrl[j] = q[j] + lead_[j];
}

Touch Cell::read() const {
  Touch touch{Eigen::VectorXd(joints()), Eigen::VectorXd(joints()), Eigen::VectorXd(joints()),
              data_->time};
  touch.give.setZero();
  for (int j = 0; j < joints(); ++j) {
    touch.q[j] = data_->qpos[motors_[j]];
    touch.velocity[j] = data_->qvel[motors_[j]];
  }
  for (const Spring& spring : springs_) touch.give[spring.joint] = data_->qpos[spring.address];
  return touch;
}

std::optional<double> Cell::reported(int plate) const {
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    if ((contact.geom1 == plate_geoms_[plate] && contact.geom2 == tip_geom_) ||
        (contact.geom2 == plate_geoms_[plate] && contact.geom1 == tip_geom_))
      return contact.dist;
  }
  return {};
}

std::optional<Touch> Cell::touch(const Approach& approach) {
  const double speed = -slope(approach.plate, approach.q).dot(approach.velocity);
  const Eigen::VectorXd begin = approach.q - kLead / speed * approach.velocity;
  settle(begin);
  std::optional<double> before;
  Touch last;
  while (data_->time * speed < kLead + kOvershoot) {
    // The first half of a step finds the contacts where the arm stands; the second moves it on.
    mj_step1(model_.get(), data_.get());
    const std::optional<double> now = reported(approach.plate);
    Touch touch = read();
    if (now && *now <= 0) {
      if (!before) return {};
      const double share = *before / (*before - *now);
      touch.q = last.q + share * (touch.q - last.q);
      touch.give = last.give + share * (touch.give - last.give);
      touch.seconds = last.seconds + share * (touch.seconds - last.seconds);
      return touch;
    }
    before = now;
    last = std::move(touch);
    follow(begin + data_->time * approach.velocity);
    mj_step2(model_.get(), data_.get());
  }
  return {};
}

}  // namespace selfcal::mujoco
