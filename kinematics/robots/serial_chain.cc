#include "kinematics/robots/serial_chain.h"

#include <array>

#include "kinematics/kernels/kernels.h"
#include "kinematics/rotation.h"

namespace selfcal::serial {
namespace {

/// Room for so many numbers without the heap: of fourteen frames over all lanes.
constexpr std::size_t kUsual = 1024, kUsualFrames = 14;

/// `count` of T in place, or on the heap where they are more than usual.
template <class T, std::size_t usual>
class Room {
 public:
  explicit Room(std::size_t count) {
    if (count > usual) more_.resize(count);
  }
  T* data() { return more_.empty() ? few_.data() : more_.data(); }

 private:
  std::array<T, usual> few_;
  std::vector<T> more_;
};

void pose_of(const Frame& frame, const Eigen::Ref<const Eigen::VectorXd>& v, double (&pose)[21]) {
  const Eigen::Vector3d phi = v.tail<3>();
  const Eigen::Matrix3d R_0 = rpy_rotation(frame.rpy_nominal);
  Eigen::Map<Eigen::Vector3d>{pose} = v.head<3>();
  Eigen::Map<Eigen::Matrix3d>{pose + 3} = R_0 * exp_rotation(phi);
  Eigen::Map<Eigen::Matrix3d>{pose + 12} = R_0 * left_jacobian_inverse(phi).inverse();
}

/// Adds the variable of joint `k` (11.16) to `sum`, a lane each.
void add_variable(const Chain& chain, const ConfigurationBlock& block, const Eigen::VectorXd& xi,
                  Eigen::Index k, Eigen::Map<Eigen::ArrayXd> sum) {
  const Eigen::Index gears = chain.first.back();
  if (block.added.rows() > 0) sum += block.added.col(k);
  for (Eigen::Index j = 0; j < chain.coupling.cols(); ++j)
    if (chain.coupling(k, j) != 0) sum += chain.coupling(k, j) * xi[gears + j] * block.q.col(j);
}

}  // namespace

void follow(const Chain& chain, const ConfigurationBlock& block, const Eigen::VectorXd& xi,
            Locations& X, PsiBlock* psi) {
  const auto lanes = static_cast<std::size_t>(block.lanes());
  const std::size_t count = chain.frames.size(), most = count * (2 + lanes);
  Room<double, kUsual> angle(most), sine(most), cosine(most), slide(count * lanes);
  Room<kernels::ChainFrame, kUsualFrames> steps(count);
  std::size_t angles = 0;
  Eigen::Index joint = 0;
  for (std::size_t f = 0; f < count; ++f) {
    const Frame& frame = chain.frames[f];
    const auto v = xi.segment(chain.first[f], frame.fields());
    kernels::ChainFrame& step = steps.data()[f];
    step = {};
    step.whole = frame.whole;
    step.column = static_cast<std::size_t>(chain.first[f]);
    if (frame.whole) {
      pose_of(frame, v, step.pose);
      continue;
    }
    step.d = v[kD];
    step.r = v[kR];
    if (frame.motion == Motion::prismatic) {
      Eigen::Map<Eigen::ArrayXd> shift(slide.data() + f * lanes, block.lanes());
      shift.setZero();
      add_variable(chain, block, xi, joint++, shift);
      step.slide = shift.data();
    }
    angle.data()[angles++] = v[kBeta];
    angle.data()[angles++] = v[kAlpha];
    step.lanes_turn = frame.motion == Motion::revolute;
    step.sine = sine.data() + angles;
    step.cosine = cosine.data() + angles;
    Eigen::Map<Eigen::ArrayXd> theta(angle.data() + angles, step.lanes_turn ? block.lanes() : 1);
    theta.setConstant(v[kTheta]);
    if (step.lanes_turn) add_variable(chain, block, xi, joint++, theta);
    angles += static_cast<std::size_t>(theta.size());
  }
  kernels::sine_cosine(angle.data(), angles, sine.data(), cosine.data());
  for (std::size_t f = 0; f < count; ++f) {
    kernels::ChainFrame& step = steps.data()[f];
    if (step.whole) continue;
    step.sin_beta = step.sine[-2];
    step.cos_beta = step.cosine[-2];
    step.sin_alpha = step.sine[-1];
    step.cos_alpha = step.cosine[-1];
  }
  kernels::follow_chain(steps.data(), count, lanes, X.rotation.data(), X.position.data(),
                        psi ? psi->data() : nullptr);
}

}  // namespace selfcal::serial
