// Messages of a domain that anyone may be in, as the generated structs have them: commands,
// replies, requests for motion, and what a service tells. The first byte chooses which.
#include <algorithm>

#include "app/report/live/fleet.h"
#include "app/report/live/message_json.h"
#include "app/report/live/message_lines.h"
#include "app/report/live/monitor_view.h"
#include "app/service/config/command_rules.h"
#include "app/web/changes.h"
#include "io/dds/convert.h"
#include "io/dds/names.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/given.h"

namespace selfcal {
namespace {

constexpr std::int64_t kNow = 1'790'000'000'000;  // ms

void try_command(Bytes& bytes) {
  const CommandMessage sent{bytes.text(), bytes.text(), bytes.text()};
  const CommandMessage command = to_plain(borrow(sent));
  promise(command.id == sent.id && command.verb == sent.verb && command.from == sent.from,
          "another command");
  const auto verb = verb_of(command.verb);
  if (!verb) return;
  promise(to_string(*verb) == command.verb, "a verb of two names");
  promise(!CommandRules{}.forbids(*verb).empty(), "nothing is allowed and it is taken");
}

void try_motion_reply(Bytes& bytes) {
  std::string outcome = bytes.text(), why = bytes.text();
  const dds::MotionReply reply{
      .id_ = bytes.take<std::uint64_t>(), .outcome_ = outcome.data(), .why_ = why.data()};
  const MotionReply plain = to_plain(reply);
  promise(plain.id == reply.id_, "a reply to another request");
  promise(to_string(plain.outcome) == outcome || plain.outcome == MotionReply::Outcome::refused,
          "an unknown outcome is taken for " + std::string(to_string(plain.outcome)));
}

void try_motion_request(Bytes& bytes) {
  std::string kind = bytes.text(), label = bytes.text(), why = bytes.text();
  std::vector<double> q(static_cast<std::size_t>(bytes.below(20)));
  for (double& each : q) each = bytes.number();
  const auto size = static_cast<std::uint32_t>(q.size());
  const dds::MotionRequest request{.id_ = bytes.take<std::uint64_t>(),
                                   .kind_ = kind.data(),
                                   .label_ = label.data(),
                                   .q_ = {size, size, q.data(), false},
                                   .speed_ = bytes.number(),
                                   .why_ = why.data()};
  const auto plain = to_plain(request);
  promise(!plain || plain->stop || plain->move.q == q, "other readings");
}

/// Nothing in it moves a terminal's cursor.
void expect_plain(const std::string& text) {
  promise(std::ranges::none_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }),
          "a control character in a line: " + text);
}

void expect_told(const Watched& watched) {
  for (const int columns : {1, 20, 80})
    for (const int rows : {1, 5, 24}) {
      const auto lines = picture(watched, kNow, columns, rows);
      promise(lines.size() <= static_cast<std::size_t>(rows), "more lines than there is room for");
      for (const Line& line : lines) expect_plain(line.text);
    }
  Watched unheard;
  unheard.robot = "b";
  const auto fleet = fleet_json({fleet_line(watched), fleet_line(unheard)});
  for (const Line& line : fleet_picture(fleet, kNow, 60, 10)) expect_plain(line.text);
  promise(line_of(fleet).find('\n') == std::string::npos, "JSON of more than a line");
}

dds::Time time_from(Bytes& bytes) {
  return {.sec_ = bytes.take<std::int32_t>(), .nanosec_ = bytes.take<std::uint32_t>()};
}

void tell(const Watched& watched) {
  for (const bool json : {false, true}) {
    MessageLines lines(json, watched.robot);
    if (watched.status) lines.add(*watched.status);
    if (watched.progress) lines.add(*watched.progress);
    if (watched.result) lines.add(*watched.result);
    lines.add(watched.robot, {kNow, "hardware", watched.health});
    lines.add_silence(watched);
    lines.flush();
  }
}

void try_told(Bytes& bytes) {
  Watched watched;
  watched.robot = ros_name(bytes.text());
  std::vector<std::string> texts;
  for (int i = 0; i < 10; ++i) texts.push_back(bytes.text());
  const dds::Status status{time_from(bytes),      texts[0].data(),  texts[1].data(),
                           texts[2].data(),       texts[3].data(),  texts[4].data(),
                           texts[5].data(),       texts[6].data(),  bytes.take<std::int64_t>(),
                           texts[7].data(),       texts[8].data(),  time_from(bytes),
                           bytes.byte() % 2 == 1, time_from(bytes), bytes.number()};
  note(watched, to_plain(status));
  const dds::Progress progress{time_from(bytes),
                               texts[0].data(),
                               bytes.take<std::int64_t>(),
                               texts[7].data(),
                               bytes.take<std::uint32_t>(),
                               bytes.take<std::uint32_t>(),
                               bytes.take<std::uint32_t>(),
                               bytes.take<double>(),
                               texts[8].data(),
                               bytes.take<std::uint32_t>(),
                               bytes.take<double>(),
                               bytes.byte() % 2 == 1,
                               texts[9].data()};
  note(watched, to_plain(progress));
  std::string answer = bytes.text(), decision = bytes.text(), cause = bytes.text();
  for (int i = bytes.below(4); i-- > 0;)
    watched.health.push_back({bytes.text(),
                              static_cast<Health>(bytes.below(4)),
                              bytes.text(),
                              {{bytes.text(), bytes.text()}}});
  const dds::Time time = time_from(bytes);
  const auto session = bytes.take<std::int64_t>();
  const double figures[] = {bytes.number(), bytes.number(), bytes.number(),
                            bytes.number(), bytes.number(), bytes.number()};
  const std::uint32_t counts[] = {bytes.take<std::uint32_t>(), bytes.take<std::uint32_t>(),
                                  bytes.take<std::uint32_t>()};
  std::string json = bytes.rest();
  json = json.substr(0, json.find('\0'));
  const dds::Result result{
      time,          texts[0].data(), texts[1].data(), session,    texts[7].data(),
      answer.data(), decision.data(), texts[9].data(), figures[0], figures[1],
      figures[2],    figures[3],      counts[0],       counts[1],  counts[2],
      json.data(),   cause.data(),    figures[4],      figures[5]};
  note(watched, to_plain(result));
  (void)changes_of_result(json);
  (void)sets_of_result(to_json(*watched.result)["result"]);
  expect_told(watched);
  tell(watched);
}

}  // namespace
}  // namespace selfcal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace selfcal;
  Bytes bytes(data, size);
  switch (bytes.below(6)) {
    case 0:
      try_command(bytes);
      break;
    case 1:
      try_motion_reply(bytes);
      break;
    case 2:
      try_motion_request(bytes);
      break;
    default:
      try_told(bytes);
  }
  return 0;
}
