// Where a further surface, socket or nest would help most.
//
// Each of several drawn at random is given as many configurations as it is worth, beside those that
// are planned or measured already; what the end position is known to then says how good it is. The
// same number of configurations without a further one says what it is to be compared with.
#pragma once

#include <string>
#include <vector>

#include "constraints/planning/plan_system.h"
#include "constraints/progress.h"

namespace selfcal {

struct NextRequest {
  PoolRequest pool;          ///< of what there is; `taken` are the configurations planned already
  Set further;               ///< what is added, where it lies unknown
  int count = 20;            ///< configurations that are added
  int tries = 24;            ///< places that are tried
  Workspace workspace = {};  ///< as in PlanRequest
};

struct NextPlace {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, of the end positions there
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of a surface, unit; zero of others
  double radius = -1;  ///< m, within which the end positions are; negative where there is none
  double sigma = 0;    ///< m, of the end position then
};

struct NextPlaces {
  std::string problem;            ///< why there are none; empty where there are
  double sigma_now = 0;           ///< m, of the end position
  double sigma_same = 0;          ///< m, after as many further configurations of what there is
  std::vector<NextPlace> places;  ///< the best first
};

NextPlaces next_places(const Robot& robot, const Eigen::VectorXd& xi, const NextRequest& request,
                       const Progress& progress = {});

}  // namespace selfcal
