#include "app/web/domain_watch.h"

#include "app/report/live/fleet.h"
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
  std::unique_ptr<DomainWatch> watch(new DomainWatch(board));
  for (std::unique_ptr<CellView>& cell : cells) {
    const std::string name = ros_name(cell->config().id);
    if (!watch->cells_.emplace(name, std::move(cell)).second)
      return bad_input("two configurations are of robot " + name);
  }
  const auto begin = [&participant, &wakeup, &board, self = watch.get(),
                      wanted = only.empty() ? "" : ros_name(only)](
                         const std::string& robot) -> Result<std::unique_ptr<RobotWatch>> {
    if (!wanted.empty() && robot != wanted) return nullptr;
    return RobotWatch::open(participant, robot, wakeup, std::move(self->cells_[robot]), board);
  };
  auto listener = DomainListener<RobotWatch>::open(participant, wakeup, begin);
  if (!listener) return tl::unexpected(listener.error());
  watch->listener_ = *std::move(listener);
  return watch;
}

Result<void> DomainWatch::take() {
  const auto news = listener_->take();
  if (!news) return tl::unexpected(news.error());
  const Nanoseconds now = monotonic_now();
  if (now - told_ < (*news ? kFleetEvery : kFleetAtLeast)) return {};
  told_ = now;
  for (const std::unique_ptr<RobotWatch>& gone : listener_->forget()) {
    cells_[gone->watched().robot] = gone->give_back_cell();
    board_.drop(gone->watched().robot);
  }
  std::vector<nlohmann::ordered_json> lines;
  for (const auto& [name, watch] : listener_->robots())
    lines.push_back(fleet_line(watch->watched()));
  board_.put("", "fleet", fleet_json(std::move(lines)));
  return {};
}

}  // namespace selfcal
