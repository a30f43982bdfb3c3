// ECMA-48: ESC [ n A goes up n lines, ESC [ H to the first; ESC [ K clears to the end of the line,
// ESC [ J to that of the screen, ESC [ 2 J all of it.
#include "app/report/live/screen.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "app/report/format.h"

namespace selfcal {

ScreenSize Screen::size() {
  winsize window{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) != 0 || window.ws_col == 0 || window.ws_row == 0)
    return {};
  return {window.ws_col, window.ws_row};
}

void Screen::draw(const std::vector<Line>& lines, const ScreenSize& size) {
  std::string text = "\r";
  if (drawn_ > 0) text = size == size_ ? printed("\r\033[%dA", drawn_) : "\033[H\033[2J";
  for (const Line& line : lines) text += painted(line) + "\033[K\n";
  text += "\033[J";
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
  drawn_ = static_cast<int>(lines.size());
  size_ = size;
}

}  // namespace selfcal
