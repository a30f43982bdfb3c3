// A data set's folder: dataset.yaml, robot.yaml and rows.csv, parted by =====. What loads in the
// form of our own files is written as one that loads to the same rows.
#include "io/files/data_set_file.h"

#include "io/files/data_set_writer.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "tests/fuzz/given.h"

namespace selfcal {
namespace {

/// Equal, NaN (an empty cell) to NaN.
bool same(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double tolerance = 0) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double x = a.reshaped()[i], y = b.reshaped()[i];
    if (!(std::isnan(x) && std::isnan(y)) && !(std::abs(x - y) <= tolerance)) return false;
  }
  return true;
}

void expect_same_rows(const DataSet& a, const DataSet& b) {
  promise(same(a.rows.q, b.rows.q), "other readings");
  promise(same(a.rows.position, b.rows.position), "other positions");
  // Unit vectors are made so again.
  promise(same(a.rows.orientation, b.rows.orientation, 1e-15), "other orientations");
  promise(same(a.rows.normal, b.rows.normal, 1e-15), "other normals");
  promise(a.rows.set == b.rows.set && a.rows.check == b.rows.check, "other sets or uses");
  promise(a.sets.size() == b.sets.size(), "other sets");
}

void try_data_set(std::string_view input) {
  const auto parts = parts_of(input, 3);
  const GivenFolder& folder = given_folder();
  const auto file = folder.write("dataset.yaml", parts[0]);
  folder.write("robot.yaml", parts[1]);
  folder.write("rows.csv", parts[2]);
  const auto loaded = load_data_set(file);
  if (!loaded) {
    promise(!loaded.error().what.empty(), "refused without a word");
    return;
  }
  auto node = read_yaml(file);
  promise(node.has_value(), "a data set without its description");
  if (node->find("columns") || node->find("orientation") || node->find("header")) return;

  Node description = node->without({"robot", "observations"});
  description.set("robot", Node::of("robot.yaml"));
  description.set("observations", Node::of("observations.csv"));
  const auto again = folder.path() / "written";
  const auto written =
      write_data_set(again, {description, "robot.yaml",
                             robot_text(*loaded->robot, values(*loaded->robot)), &loaded->data});
  promise(written.has_value(), written ? "" : written.error().what);
  const auto reloaded = load_data_set(again);
  promise(reloaded.has_value(), reloaded ? "" : reloaded.error().what);
  expect_same_rows(loaded->data, reloaded->data);
}

}  // namespace
}  // namespace selfcal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  selfcal::try_data_set(selfcal::text_of(data, size));
  return 0;
}
