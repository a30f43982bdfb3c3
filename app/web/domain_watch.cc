#include "app/web/domain_watch.h"

#include "app/web/fleet.h"
#include "io/dds/names.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kFleetEvery = kSecond / 4;  // the list of robots goes to the board
constexpr Nanoseconds kFleetAtLeast = kSecond;

}  // namespace

Result<std::unique_ptr<DomainWatch>> DomainWatch::open(const DdsParticipant& participant,
                                                       const std::string& only,
                                                       std::vector<std::unique_ptr<CellView>> cells,
                                                       Wakeup& wakeup, Board& board) {
  std::unique_ptr<DomainWatch> watch(
      new DomainWatch(participant, only.empty() ? "" : ros_name(only), wakeup, board));
  auto discovery = DdsRobots::open(participant, wakeup);
  if (!discovery) return tl::unexpected(discovery.error());
  watch->discovery_ = *std::move(discovery);
  auto diagnostics = DdsDiagnostics::open(participant, wakeup);
  if (!diagnostics) return tl::unexpected(diagnostics.error());
  watch->diagnostics_ = *std::move(diagnostics);
  for (std::unique_ptr<CellView>& cell : cells) {
    const std::string name = ros_name(cell->config().id);
    if (!watch->cells_.emplace(name, std::move(cell)).second)
      return bad_input("two configurations are of robot " + name);
  }
  return watch;
}

Result<void> DomainWatch::find() {
  const auto heard = discovery_->heard();
  if (!heard) return tl::unexpected(heard.error());
  for (const std::string& robot : *heard) {
    if (robots_.contains(robot) || robots_.size() >= kMostRobots) continue;
    if (!only_.empty() && robot != only_) continue;
    auto watch = RobotWatch::open(participant_, robot, wakeup_, std::move(cells_[robot]), board_);
    if (!watch) return tl::unexpected(watch.error());
    robots_[robot] = *std::move(watch);
  }
  return {};
}

void DomainWatch::forget() {
  for (auto each = robots_.begin(); each != robots_.end();) {
    RobotWatch& watch = *each->second;
    if (watch.connected() || watch.watched().silent < kRemembered) {
      ++each;
      continue;
    }
    cells_[each->first] = watch.give_back_cell();
    board_.drop(each->first);
    each = robots_.erase(each);
  }
}

Result<void> DomainWatch::take() {
  if (auto found = find(); !found) return found;
  bool news = false;
  const auto health = diagnostics_->take();
  for (const auto& [name, watch] : robots_) {
    const auto of_robot = health.find(name);
    news = watch->take(of_robot == health.end() ? std::vector<HealthReport>() : of_robot->second) ||
           news;
  }
  const Nanoseconds now = monotonic_now();
  if (now - told_ < (news ? kFleetEvery : kFleetAtLeast)) return {};
  told_ = now;
  forget();
  std::vector<nlohmann::ordered_json> lines;
  for (const auto& [name, watch] : robots_) lines.push_back(fleet_line(watch->watched()));
  board_.put("", "fleet", fleet_json(std::move(lines)));
  return {};
}

}  // namespace selfcal
