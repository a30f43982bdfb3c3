// What the raw counts of a session's touches mean, as it is stored with them.
#pragma once

#include <string>
#include <vector>

#include "app/service/config/config.h"
#include "app/service/front_end/reading.h"
#include "constraints/methods/data_set.h"
#include "io/store/store.h"

namespace selfcal {

/// What is stored with a session so that its raw counts can be understood in ten years.
struct Decoding {
  double target = 1e-3;  ///< m, in the workspace
  Workspace workspace;
  double delay = 0;    ///< s, of the trigger
  double payload = 0;  ///< kg, on the tool in the touches that are made with it
  std::vector<EncoderScale> scales;
  std::vector<Eigen::Vector3d> outward;  ///< by set, way out of the contact (world)
  std::vector<Set> sets;
};

/// Text of the decoding of the touches that a session is going to make, and back.
std::string decoding_text(const Config& config, const std::vector<EncoderScale>& scales);
Result<Decoding> read_decoding(const std::string& text);
/// Of all that changes what the touches mean: sets, robot, where readings and edges come from and
/// what their counts stand for. Rows of sessions with different ones do not belong together.
std::string config_hash(const Config& config, const std::vector<EncoderScale>& scales);

/// Of a set by its name; that of the first where there is none.
int set_index(const Decoding& decoding, const std::string& name);

/// Joint readings at the edge of a touch.
Reading reading_of(const TouchRecord& touch, const Decoding& decoding);

}  // namespace selfcal
