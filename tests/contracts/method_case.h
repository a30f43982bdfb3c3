// Every constraint method with the options that change what it does, and random instances of it:
// locations, readings, own and group values.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "io/files/yaml.h"
#include "kinematics/rotation.h"

namespace selfcal {

/// Sets as in a data set's file; the one under test is called s.
struct MethodCase {
  std::string title;  ///< letters only: names the test
  std::string sets;
  bool scale_free = false;   ///< its rows hold for a robot of any size
  bool of_platform = false;  ///< it speaks of joints that a platform has, and an arm lacks
};

inline void PrintTo(const MethodCase& each, std::ostream* out) { *out << each.sets; }

/// A new line in methods.def needs at least one case here.
inline std::vector<MethodCase> method_cases() {
  return {
      {"Position", "s: {method: position}"},
      {"PositionInAnUnknownFrame", "s: {method: position, frame: unknown}"},
      {"PositionOfAnUnknownPoint", "s: {method: position, point: unknown}"},
      {"PositionOfAnUnknownPointInAnUnknownFrame",
       "s: {method: position, frame: unknown, point: unknown}"},
      {"Location", "s: {method: location}"},
      {"LocationInAnUnknownFrame", "s: {method: location, frame: unknown}"},
      {"Distance", "s: {method: distance}"},
      {"FixedPointDistance", "s: {method: fixed-point-distance}"},
      {"FixedPointDistanceOfAnUnknownOffset", "s: {method: fixed-point-distance, offset: unknown}"},
      {"FixedPointDistanceOfAnUnknownScale", "s: {method: fixed-point-distance, scale: unknown}",
       true},
      {"FixedPointDistanceOfAKnownCentre",
       "s: {method: fixed-point-distance, center: [0.6, 0.1, -0.5]}"},
      {"FixedPointDistanceOfAnUnknownPoint", "s: {method: fixed-point-distance, point: unknown}"},
      {"FixedPointDistanceOfAKnownCentreWithUnknownOffsetAndPoint",
       "s: {method: fixed-point-distance, center: [0.6, 0.1, -0.5], offset: unknown,"
       " point: unknown}"},
      {"FixedPointDistanceOfAllUnknown",
       "s: {method: fixed-point-distance, offset: unknown, scale: unknown, point: unknown}", true},
      {"Bearing", "s: {method: bearing}", true},
      {"BearingFromAnUnknownStation", "s: {method: bearing, frame: unknown}", true},
      {"BearingOfAnUnknownPoint", "s: {method: bearing, point: unknown}", true},
      {"BearingOfAnUnknownPointFromAnUnknownStation",
       "s: {method: bearing, frame: unknown, point: unknown}", true},
      {"PositionConstraint", "s: {method: position-constraint}", true},
      {"PositionConstraintWithGroupsApart",
       "s: {method: position-constraint, apart: [{groups: [a, b], distance: 0.3, noise: 1.0e-4}]}"},
      {"LocationConstraint", "s: {method: location-constraint}", true},
      {"PlaneUnknown", "s: {method: plane}", true},
      {"PlaneKnown", "s: {method: plane, plane: [0.1, 0.2, -2.0]}"},
      {"PlaneWithAProbe", "s: {method: plane, probe_radius: 0.05}", true},
      {"PlaneParallelToAnUnknownOne",
       "s: {method: plane, parallel_to: {set: other, distance: 0.2, noise: 1.0e-5}}\n"
       "other: {method: plane}"},
      {"PlaneParallelToAKnownOneWithAProbe",
       "s: {method: plane, probe_radius: 0.05,"
       " parallel_to: {set: other, distance: 0.2, noise: 1.0e-5}}\n"
       "other: {method: plane, plane: [0.1, 0.2, -2.0]}"},
      {"PlaneNormalUnknown", "s: {method: plane-normal}", true},
      {"PlaneNormalKnown", "s: {method: plane-normal, normal: [1, 2, -3]}", true},
      {"SphereUnknown", "s: {method: sphere}", true},
      {"SphereOfKnownCentre", "s: {method: sphere, center: [0.6, 0.1, 0.5]}"},
      {"SphereOfKnownRadius", "s: {method: sphere, radius: 0.1}"},
      {"Inclinometers", "s: {method: inclinometers}", true},
      {"LockedUniversalJoint", "s: {method: locked-joint, lock: {leg: 2, joint: universal}}", true,
       true},
      {"LockedSphericalJoint", "s: {method: locked-joint, lock: {leg: 5, joint: spherical}}", true,
       true},
      {"ConstraintLink", "s: {method: constraint-link, length: 0.75}"},
      {"CirclePoint", "s: {method: circle-point, joint: j2}"},
      {"CirclePointOfMostMarkers", "s: {method: circle-point, joint: j2, markers: 6}"},
      {"SphereKnown", "s: {method: sphere, center: [0.6, 0.1, 0.5], radius: 0.1}"},
  };
}

inline std::string title_of(const testing::TestParamInfo<MethodCase>& info) {
  return info.param.title;
}

/// The sets that `text` lists, tied together.
inline std::vector<Set> make_sets(const std::string& text) {
  const auto node = parse_yaml(text, "dataset.yaml");
  EXPECT_TRUE(node.has_value()) << node.error().what;
  Problems problems;
  std::vector<Set> sets = read_sets(node.value_or(Node::map()), problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  return sets;
}

inline Eigen::Vector3d random_vector(Random& random, double most) {
  std::uniform_real_distribution<double> part(-most, most);
  return {part(random), part(random), part(random)};
}

/// Anywhere within a metre, turned any way.
inline Location random_location(Random& random) {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return {q.normalized().toRotationMatrix(), random_vector(random, 1)};
}

inline void place(Locations& X, int lane, const Location& at) {
  X.rotation.row(lane) = at.R.reshaped().transpose().array();
  X.position.row(lane) = at.p.transpose().array();
}

/// A method with everything that evaluate() looks at, kLanes rows in three groups.
struct Instance {
  std::vector<Set> sets;
  Observations data;
  std::vector<int> rows;
  Locations now, before;
  Eigen::VectorXd nuisance, reference;
  Eigen::MatrixXd groups;

  const Method& method() const { return *sets[0].method; }
  const Method* referred() const {
    return sets[0].reference < 0 ? nullptr : sets[sets[0].reference].method.get();
  }
  int equations() const { return static_cast<int>(method().equations().size()); }

  MethodOutput evaluate() const {
    MethodOutput out;
    out.resize(equations(), method().tangent_dimension(),
               referred() ? referred()->tangent_dimension() : 0, method().group_freedom());
    const MethodInput in{
        kLanes, &data, rows.data(), &now, &before, &nuisance, referred() ? &reference : nullptr,
        &groups};
    method().evaluate(in, out);
    return out;
  }

  /// Length of the angle part of a lane's residual.
  double angle(const MethodOutput& out, int lane) const {
    double squares = 0;
    for (int a = 0; a < equations(); ++a)
      if (method().equations()[a] == Quantity::angle) squares += std::pow(out.r(lane, a), 2);
    return std::sqrt(squares);
  }
};

inline constexpr double kLargestAngle = 2.5;  ///< orientation errors of random instances (rad)

inline Instance random_instance(const MethodCase& each, Random& random) {
  constexpr int kGroups = 3;
  Instance made;
  made.sets = make_sets(each.sets);
  const Method& method = made.method();
  made.data.q.setZero(kLanes, 1);
  made.data.position.resize(kLanes, 3);
  made.data.orientation.resize(kLanes, 4);
  for (const MeasuredColumn& column : method.measures())
    made.data.measured[column.name].setConstant(kLanes, 0.4);
  made.data.normal.resize(kLanes, 3);
  for (int lane = 0; lane < kLanes; ++lane) {
    const Eigen::Quaterniond q(random_location(random).R);
    made.data.position.row(lane) = random_vector(random, 1).transpose();
    made.data.orientation.row(lane) << q.w(), q.x(), q.y(), q.z();
    made.data.normal.row(lane) = random_vector(random, 1).normalized().transpose();
    made.data.group.push_back(lane % kGroups);
    made.rows.push_back(lane);
    place(made.now, lane, random_location(random));
    place(made.before, lane, random_location(random));
  }
  if (made.referred())
    made.reference = made.referred()->through(random_location(random), nullptr, random);
  made.nuisance =
      method.through(random_location(random), made.referred() ? &made.reference : nullptr, random);
  for (int g = 0; method.group_freedom() > 0 && g < kGroups; ++g) {
    const Eigen::VectorXd values = method.start_group({random_location(random)});
    made.groups.conservativeResize(values.size(), kGroups);
    made.groups.col(g) = values;
  }
  // From a station far off, every location is in nearly the same direction.
  while (method.frame_unknown() && made.angle(made.evaluate(), 0) > kLargestAngle)
    made.nuisance = method.through(random_location(random), nullptr, random);
  for (int lane = 0; lane < kLanes; ++lane)
    while (made.angle(made.evaluate(), lane) > kLargestAngle)
      place(made.now, lane, random_location(random));
  return made;
}

}  // namespace selfcal
