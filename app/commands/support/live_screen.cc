#include "app/commands/support/live_screen.h"

#include "app/commands/support/signals.h"
#include "app/report/format.h"
#include "app/report/live/keyboard.h"
#include "app/report/live/screen.h"
#include "io/clock.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kRedraw = kSecond / 20;  // at most so often

}  // namespace

Result<void> show_live(Wakeup& wakeup, const std::function<Result<bool>()>& take,
                       const std::function<std::vector<Line>(int columns, int rows)>& draw) {
  const Keyboard keyboard;
  Screen screen;
  ScreenSize drawn_for;
  Nanoseconds drawn = 0;
  bool news = true, held = false;
  std::vector<Line> lines;
  while (!told_to_stop()) {
    bool asked = false;
    while (const auto key = keyboard.pressed()) {
      if (*key == 'q' || *key == 'Q') return {};
      if (*key == 'p' || *key == 'P' || *key == ' ') {
        held = !held;
        asked = true;
      }
    }
    const auto taken = take();
    if (!taken) return tl::unexpected(taken.error());
    news = *taken || news;
    const Nanoseconds now = monotonic_now();
    const ScreenSize size = Screen::size();
    const bool due = (news && now - drawn >= kRedraw) || now - drawn >= kSecond;
    if (asked || size != drawn_for || (due && !held)) {
      // Held still, a picture is drawn anew only where the terminal has another size.
      if (!held || lines.empty() || size != drawn_for)
        lines = draw(size.columns - 1, size.rows - 2);
      std::vector<Line> shown = lines;
      shown.push_back(
          {fitted(held ? "HELD STILL   p: go on   q: leave" : "p: hold still   q: leave",
                  size.columns - 1),
           held ? Tone::warning : Tone::plain, 0});
      screen.draw(shown, size);
      drawn = now;
      drawn_for = size;
      news = false;
    }
    wakeup.wait(news && !held ? kRedraw : kSignalWait);
  }
  return {};
}

}  // namespace selfcal
