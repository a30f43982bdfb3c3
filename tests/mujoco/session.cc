#include "tests/mujoco/session.h"

#include <cmath>
#include <fstream>

#include "tests/mujoco/cell.h"

namespace selfcal::mujoco {
namespace {

constexpr double kNormalNoise = 1e-3;
constexpr double kRepeatPause = 8, kPause = 25;  // s

class Recorder {
 public:
  Recorder(const std::filesystem::path& file, const std::vector<Plate>& plates, int joints)
      : plates_(plates), out_(file) {
    out_.precision(12);
    out_ << "set";
    for (const char* each : {",q", ",dq"})
      for (int j = 1; j <= joints; ++j) out_ << each << j;
    out_ << ",nx,ny,nz,temperature,time,repeat,part\n";
  }

  /// `slope`: of the distance from the plate to the readings.
  void write(int plate, const Touch& touch, const Eigen::VectorXd& slope, double noise,
             const std::string& labels, Random& random) {
    const Eigen::VectorXd q = touch.q + noise * normal(random) / slope.squaredNorm() * slope;
    out_ << plates_[plate].name;
    for (const double each : q) out_ << ',' << each;
    for (const double each : touch.velocity) out_ << ',' << each;
    Eigen::Vector3d n = plates_[plate].normal;
    for (double& each : n) each += kNormalNoise * normal(random);
    for (const double each : n.normalized()) out_ << ',' << each;
    now_ += touch.seconds;
    // The hall warms up, which the arm does not mind.
    const double air = 21 - 5 * std::expm1(-now_ / 2500) + 0.05 * normal(random);
    out_ << ',' << air << ',' << now_ << ',' << labels << '\n';
  }

  void pause(double seconds) { now_ += seconds; }

 private:
  const std::vector<Plate>& plates_;
  std::ofstream out_;
  double now_ = 0;
};

void write_descriptions(const std::filesystem::path& folder, const Arm& nominal, const Arm& built,
                        const std::vector<Plate>& plates) {
  std::ofstream(folder / "arm.robot.yaml") << robot_yaml(nominal);
  std::ofstream(folder / "arm.mjcf.xml") << mjcf(built, plates);
  std::ofstream file(folder / "dataset.yaml");
  file << "robot: arm.robot.yaml\nobservations: observations.csv\nsets:\n";
  for (const Plate& plate : plates) file << "  " << plate.name << ": {method: plane}\n";
}

}  // namespace

Session make_session(const std::filesystem::path& folder, const SessionOrder& order) {
  Random random(order.seed);
  const Arm nominal = draw_arm(random);
  Session session;
  session.built = draw_built(nominal, random);
  for (const auto& [joint, c] : order.compliance) session.built.frame(joint).compliance = c;
  const std::vector<Plate> plates = draw_plates(random);
  session.noise = uniform(random, order.least_noise, order.most_noise);
  const auto rows = static_cast<int>(uniform(random, order.least_rows, order.most_rows));

  std::filesystem::create_directories(folder);
  write_descriptions(folder, nominal, session.built, plates);
  Cell cell(folder / "arm.mjcf.xml", plates);
  Recorder recorder(folder / "observations.csv", plates, cell.joints());
  std::uniform_int_distribution<int> any(0, static_cast<int>(plates.size()) - 1);
  for (int configuration = 0; session.rows < rows; ++configuration) {
    const int plate = any(random);
    std::optional<Approach> approach;
    std::optional<Touch> touch;
    while (!touch) {
      approach = cell.plan(plate, nominal, random);
      if (approach) touch = cell.touch(*approach);
    }
    const bool repeats = uniform(random, 0, 1) < order.repeated;
    const int times = repeats ? 2 + (uniform(random, 0, 1) < 0.5) : 1;
    const std::string part = uniform(random, 0, 1) < order.checked ? "check" : "fit";
    const std::string label = repeats ? "r" + std::to_string(configuration) : "";
    recorder.pause(-kPause * std::log(uniform(random, 1e-6, 1)));
    for (int k = 0; k < times; ++k) {
      if (k > 0) {
        recorder.pause(kRepeatPause);
        touch = cell.touch(*approach);
      }
      recorder.write(plate, *touch, cell.slope(plate, touch->q), session.noise, label + ',' + part,
                     random);
    }
    session.rows += times;
  }
  return session;
}

}  // namespace selfcal::mujoco
