// A file of wanted poses.
#include "io/files/poses_csv.h"

#include "tests/fuzz/given.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace selfcal;
  const auto poses =
      read_poses(given_folder().write("poses.csv", text_of(data, size)),
                 std::vector<Joint>(3, Joint{.name = "j", .quantity = Quantity::angle}));
  if (!poses) return 0;
  promise(!poses->empty(), "accepted without a row");
  for (const WantedPose& pose : *poses) {
    promise(pose.location.p.allFinite() && pose.near.allFinite(), "a number is not finite");
    promise(
        (pose.location.R.transpose() * pose.location.R - Eigen::Matrix3d::Identity()).norm() < 1e-9,
        "no rotation");
  }
  return 0;
}
