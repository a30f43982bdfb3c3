// The session in progress as the store has it, and what its touches mean as rows of a data set.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/service/config.h"
#include "app/service/senses/reading.h"
#include "constraints/methods/data_set.h"
#include "io/store/store.h"

namespace selfcal {

struct Session {
  SessionRecord record;
  std::vector<StepRecord> plan;
  std::vector<TouchRecord> touches;
  SessionKind kind() const { return kind_of(record.kind).value_or(SessionKind::full); }
};

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

/// Readings as the store and the ports have them, as a vector.
Eigen::VectorXd vector_of(const std::vector<double>& readings);

/// Text of the decoding of the touches that a session is going to make, and back.
std::string decoding_text(const Config& config, const std::vector<EncoderScale>& scales);
Result<Decoding> read_decoding(const std::string& text);
/// Of all that changes what the touches mean: sets, robot, where readings and edges come from and
/// what their counts stand for. Rows of sessions with different ones do not belong together.
std::string config_hash(const Config& config, const std::vector<EncoderScale>& scales);

/// Of a set by its name; that of the first where there is none.
int set_index(const Decoding& decoding, const std::string& name);

/// The plan as the store keeps it.
std::vector<StepRecord> steps_of(const TouchPlan& plan, const std::vector<Set>& sets);

/// Good touches of a step so far; those before a touch that differed from them do not count.
std::vector<const TouchRecord*> good_touches(const Session& session, int step);
/// The first step that needs another touch.
int next_step(const Session& session, int repeats, int attempts);
/// Steps that are put aside: no attempt is left and too few touches are good.
int steps_put_aside(const Session& session, int repeats, int attempts);

/// Joint readings at the edge of a touch.
Reading reading_of(const TouchRecord& touch, const Decoding& decoding);

/// The rows that the good touches make, in the order of the plan, with speed, time and temperature.
/// With `all_check` every row only judges, with `all_fit` every row identifies. A row's noise is
/// that of its set and, on top, what the reading leaves open (Reading::sigma_time) at the speed at
/// which `robot`, nearly the true one, came in. Each engagement of a lock has constants of its own:
/// the first is the set, a later one a set NAME-2, NAME-3 … (a free name) beside it; one of fewer
/// than kFewestOfLock rows, two of them to fit, is left out beside one that has more.
inline constexpr int kFewestOfLock = 4;
enum class Parts { as_planned, all_check, all_fit };
DataSet rows_of(const Robot& robot, const Session& session, const Decoding& decoding,
                Parts parts = Parts::as_planned);

/// The step of the plan that each of these rows comes from.
std::vector<int> steps_of_rows(const Session& session, const Decoding& decoding);

/// The fit rows of `base` and the rows of `check` as rows that judge; both have the same sets.
DataSet joined(const DataSet& base, const DataSet& check);

/// How a touch is judged before it is stored: a machine with loops must be able to stand at the
/// readings, and the end position lie near the surface, and near that of the touches before.
struct TouchDecision {
  TouchOutcome outcome = TouchOutcome::taken;
  std::string why;
};
TouchDecision decide_on_touch(const Robot& robot, const Session& session, const Decoding& decoding,
                              const StepRecord& step, const Reading& reading, double search,
                              double tolerance);

/// Readings under a lock: legs within their lengths, and the loop closes in its assembly mode.
TouchDecision decide_on_visit(const Robot& robot, const Reading& reading);

/// Endpoint at readings `q`, at which the robot's loops must close, with its own values (m, world).
Eigen::Vector3d endpoint(const Robot& robot, const Eigen::VectorXd& q);

/// The session up to `step`, of each set the last touches alone: as many as tell where a surface
/// is, however long the session.
Session lately(const Session& session, std::size_t step);

/// Distance of the last row from its surface (socket) as the rows so far have it, with the robot's
/// own values; nothing while they are too few to tell (m).
std::optional<double> running_residual(const Robot& robot, const DataSet& data);

}  // namespace selfcal
