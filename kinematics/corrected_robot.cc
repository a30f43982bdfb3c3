// X = X_geometry(q + A v) carried along by the twist B v = (shift, turn) of the tip:
//   p += shift + turn x a,   R = exp(turn) R,   a the body's origin as seen from the tip
// A, B and a are taken at the model's own values and do not follow xi. So Psi has, exactly,
//   (p', exp(turn) w')
// of each column (p', w') of the geometry's Psi where the joints then are, the same of J A for the
// effects' parameters, and there, for a column (b, w) of B and the left Jacobian Jl of SO(3), also
//   (b + w x a, Jl(turn) w).
#include "kinematics/corrected_robot.h"

#include <algorithm>
#include <cmath>

#include "kinematics/block_memory.h"
#include "kinematics/deviations.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

constexpr double kLooseness = 10;           ///< prior sigma over the largest usual size
constexpr std::size_t kMostKept = 8 << 20;  ///< bytes of regressors: thousands of rows

bool same_text(const Node& a, const Node& b) {
  return a.kind == b.kind && a.text == b.text && a.keys == b.keys &&
         std::ranges::equal(a.items, b.items, same_text);
}

/// Two effects that differ in their parameters alone: these add up, for effects are linear in them.
bool add_up(const Effect& a, const Effect& b) {
  const auto shape = [](const Effect& effect) {
    return effect
        .describe(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effect.parameters().size())))
        .without({"named"});
  };
  return same_text(shape(a), shape(b));
}

class CorrectedRobot final : public Robot, public RobotText {
 public:
  CorrectedRobot(std::shared_ptr<const Robot> geometry, Effects effects)
      : geometry_(std::move(geometry)),
        effects_(std::move(effects)),
        parameters_(geometry_->parameters()),
        preference_(geometry_->preference()) {
    for (const auto& effect : effects_)
      for (const EffectParameter& p : effect->parameters()) {
        std::string place = effect->at().empty() ? "robot" : effect->at();
        // A base that is a whole pose has a base.x of its own.
        if (find_parameter(*geometry_, place + "." + p.name) >= 0) place = effect->name();
        Parameter parameter{free_name(place + "." + p.name), place, p.name, Quantity::other,
                            Part::effect};
        parameter.value = p.value;
        parameter.tolerance = kLooseness * p.usual_most;
        parameter.free = false;
        parameter.other_unit = p.unit;
        preference_.push_back(static_cast<int>(parameters_.size()));
        parameters_.push_back(std::move(parameter));
      }
  }

  const std::shared_ptr<const Robot>& geometry() const { return geometry_; }
  const Effects& effects() const { return effects_; }

  std::string_view kind() const override { return geometry_->kind(); }
  const std::string& name() const override { return geometry_->name(); }
  const std::vector<Joint>& joints() const override { return geometry_->joints(); }
  const std::vector<Parameter>& parameters() const override { return parameters_; }
  const std::vector<int>& preference() const override { return preference_; }
  const Statics* statics() const override { return geometry_->statics(); }
  const PointMasses* masses() const override { return geometry_->masses(); }
  const std::vector<std::string>& links() const override { return geometry_->links(); }
  bool has_loops() const override { return geometry_->has_loops(); }
  std::optional<Location> home() const override { return geometry_->home(); }
  const std::vector<PassiveJoint>& passive_joints() const override {
    return geometry_->passive_joints();
  }
  std::vector<FrameMotions> frame_motions(const Eigen::VectorXd& xi) const override {
    std::vector<FrameMotions> list = geometry_->frame_motions(xi.head(geometry_parameters()));
    for (FrameMotions& each : list)
      each.moves.conservativeResizeLike(Eigen::MatrixXd::Zero(xi.size(), each.moves.cols()));
    return list;
  }
  bool within_passive_limits(const Eigen::VectorXd& q) const override {
    return geometry_->within_passive_limits(q);
  }
  Eigen::Vector3d tool_axis() const override { return geometry_->tool_axis(); }
  Eigen::VectorXd draw(const Eigen::MatrixX2d& span,
                       const std::function<double()>& uniform) const override {
    return geometry_->draw(span, uniform);
  }
  int variable_parameter(int j) const override { return geometry_->variable_parameter(j); }
  Eigen::VectorXd variable_change(const Eigen::VectorXd& xi, int j) const override {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(xi.size());
    change.head(geometry_parameters()) =
        geometry_->variable_change(xi.head(geometry_parameters()), j);
    return change;
  }
  Eigen::MatrixXd variables_per_reading(const Eigen::VectorXd& xi) const override {
    return geometry_->variables_per_reading(xi.head(geometry_parameters()));
  }
  int leg_parameter(int j) const override { return geometry_->leg_parameter(j); }
  Eigen::VectorXd leg_lengths(const Eigen::VectorXd& xi, const Eigen::VectorXd& q) const override {
    return geometry_->leg_lengths(xi.head(geometry_parameters()), q);
  }
  std::string identity() const override { return geometry_->text().identity(); }
  const RobotText& text() const override { return *this; }
  std::vector<std::string> remarks() const override {
    std::vector<std::string> lines = geometry_->text().remarks();
    for (const auto& effect : effects_)
      for (const EffectParameter& p : effect->parameters())
        if (p.positive && p.value < -p.usual_least)  // an estimate of nothing may lie below
          lines.push_back(std::string(effect->name()) +
                          (effect->at().empty() ? "" : " at " + effect->at()) + ": " + p.name +
                          " is " + format_number(p.value) + " " + p.unit +
                          ", below zero, which no machine has (its sign?)");
    return lines;
  }

  Closure locate(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body,
                 Locations& X, PsiBlock* psi) const override {
    const auto kept = memory_.of(block, body, bytes_of(block),
                                 [&] { return deviations_of(*geometry_, effects_, block, body); });
    const std::vector<LaneDeviation>& deviations = *kept;
    const Eigen::VectorXd own = xi.head(geometry_parameters());
    const Eigen::VectorXd v = xi.tail(xi.size() - own.size());
    ConfigurationBlock moved{block.q, block.count};
    moved.start = block.start;
    moved.near = block.near;
    moved.added.setZero(block.lanes(), block.q.cols());
    for (int lane = 0; lane < block.lanes(); ++lane)
      moved.added.row(lane) = (deviations[lane].by.joints * v).transpose().array();
    PsiBlock inner;
    Closure closure = geometry_->locate(moved, own, body, X, psi ? &inner : nullptr);
    if (psi) fill(deviations, own, v, inner, *psi);
    for (int lane = 0; lane < block.lanes(); ++lane) {
      const Eigen::Matrix<double, 6, 1> twist = deviations[lane].by.tip * v;
      if (twist.isZero(0)) continue;
      const Eigen::Vector3d turn = twist.tail<3>();
      const Eigen::Matrix3d R = exp_rotation(turn) * X.R(lane);
      X.position.row(lane) +=
          (twist.head<3>() + turn.cross(deviations[lane].arm)).transpose().array();
      X.rotation.row(lane) = R.reshaped().transpose().array();
    }
    return closure;
  }

  void joint_jacobian(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body,
                      const PsiBlock& psi, Eigen::MatrixXd& J) const override {
    geometry_->joint_jacobian(block, xi.head(geometry_parameters()), body,
                              psi.leftCols(geometry_parameters()), J);
  }

  Node describe(const Eigen::VectorXd& xi) const override {
    Node node = geometry_->text().describe(xi.head(geometry_parameters()));
    Node list = Node::list();
    std::vector<Eigen::VectorXd> value;
    std::vector<size_t> entries;
    Eigen::Index at = geometry_parameters();
    for (size_t i = 0; i < effects_.size(); ++i) {
      const auto count = static_cast<Eigen::Index>(effects_[i]->parameters().size());
      value.emplace_back(xi.segment(at, count));
      at += count;
      const auto same = std::ranges::find_if(
          entries, [&](size_t other) { return add_up(*effects_[i], *effects_[other]); });
      if (same != entries.end())
        value[*same] += value.back();
      else
        entries.push_back(i);
    }
    for (const size_t i : entries) list.items.push_back(effects_[i]->describe(value[i]));
    node.set("effects", std::move(list));
    return node;
  }

 private:
  std::size_t bytes_of(const ConfigurationBlock& block) const {
    const std::size_t effects =
        parameters_.size() - static_cast<std::size_t>(geometry_parameters());
    return static_cast<std::size_t>(block.lanes()) * (effects * (joints().size() + 6) + 3) *
           sizeof(double);
  }

  Eigen::Index geometry_parameters() const {
    return static_cast<Eigen::Index>(geometry_->parameters().size());
  }

  /// The name, or of an effect that is at one place again, at another moment, the name with a
  /// number.
  std::string free_name(const std::string& name) const {
    const auto taken = [&](const std::string& each) {
      return std::ranges::any_of(parameters_, [&](const Parameter& p) { return p.name == each; });
    };
    std::string free = name;
    for (int again = 2; taken(free); ++again) free = name + "_" + std::to_string(again);
    return free;
  }

  /// `inner` is Psi of the geometry alone.
  void fill(const std::vector<LaneDeviation>& deviations, const Eigen::VectorXd& xi,
            const Eigen::VectorXd& v, const PsiBlock& inner, PsiBlock& psi) const {
    const Eigen::Index own = geometry_parameters(), n = static_cast<Eigen::Index>(joints().size());
    const Eigen::Index lanes = inner.rows() / 6;
    psi.resize(6 * lanes, static_cast<Eigen::Index>(parameters_.size()));
    psi.leftCols(own) = inner;
    Eigen::MatrixXd J(6, n);
    std::vector<Eigen::VectorXd> by_variable;  // of the whole block
    for (Eigen::Index j = 0; j < n; ++j)
      by_variable.emplace_back(inner * geometry_->variable_change(xi, static_cast<int>(j)));
    for (Eigen::Index lane = 0; lane < lanes; ++lane) {
      const Regressor& by = deviations[static_cast<size_t>(lane)].by;
      for (Eigen::Index j = 0; j < n; ++j)
        for (int c = 0; c < 6; ++c) J(c, j) = by_variable[static_cast<size_t>(j)][c * lanes + lane];
      Eigen::MatrixXd columns = J * by.joints;
      const Eigen::Vector3d turn = by.tip.bottomRows<3>() * v;
      if (!turn.isZero(0)) {
        const Eigen::Matrix3d E = exp_rotation(turn);
        columns.bottomRows<3>() = (E * columns.bottomRows<3>()).eval();
        Eigen::MatrixXd turns(3, own);
        for (int c = 0; c < 3; ++c) turns.row(c) = inner.row((3 + c) * lanes + lane);
        turns = (E * turns).eval();
        for (int c = 0; c < 3; ++c) psi.row((3 + c) * lanes + lane).head(own) = turns.row(c);
      }
      columns.topRows<3>() +=
          by.tip.topRows<3>() -
          skew(deviations[static_cast<size_t>(lane)].arm) * by.tip.bottomRows<3>();
      columns.bottomRows<3>() += left_jacobian_inverse(turn).inverse() * by.tip.bottomRows<3>();
      for (int c = 0; c < 6; ++c) psi.row(c * lanes + lane).tail(v.size()) = columns.row(c);
    }
  }

  std::shared_ptr<const Robot> geometry_;
  Effects effects_;
  std::vector<Parameter> parameters_;
  std::vector<int> preference_;
  /// A, B and a do not follow xi.
  mutable BlockMemory<std::vector<LaneDeviation>> memory_{kMostKept};
};

}  // namespace

std::unique_ptr<Robot> correct(std::shared_ptr<const Robot> robot, const std::vector<Node>& entries,
                               const MeasurementContext& context, Problems& problems) {
  robot = geometry_of(std::move(robot));
  Effects effects;
  for (const Node& entry : entries) {
    auto effect = make_effect(entry, *robot, context, problems);
    if (!effect) return nullptr;
    effects.push_back(std::move(effect));
  }
  if (problems.any()) return nullptr;
  return std::make_unique<CorrectedRobot>(std::move(robot), std::move(effects));
}

std::vector<const Effect*> effects_of(const Robot& robot) {
  std::vector<const Effect*> list;
  if (const auto* corrected = dynamic_cast<const CorrectedRobot*>(&robot))
    for (const auto& effect : corrected->effects()) list.push_back(effect.get());
  return list;
}

std::vector<Node> effect_entries(const Robot& robot) {
  const Node whole = robot.text().describe(values(robot));
  const Node* list = whole.find("effects");
  return list ? list->items : std::vector<Node>();
}

std::shared_ptr<const Robot> geometry_of(std::shared_ptr<const Robot> robot) {
  const auto* corrected = dynamic_cast<const CorrectedRobot*>(robot.get());
  return corrected ? corrected->geometry() : robot;
}

}  // namespace selfcal
