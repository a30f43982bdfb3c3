#include "app/report/live/keyboard.h"

#include <poll.h>
#include <unistd.h>

namespace selfcal {

Keyboard::Keyboard() {
  // A background job that changed the terminal would be stopped by it.
  if (::tcgetattr(STDIN_FILENO, &before_) != 0 || ::tcgetpgrp(STDIN_FILENO) != ::getpgrp()) return;
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = 1;
  raw.c_cc[VTIME] = 0;
  is_terminal_ = ::tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
}

Keyboard::~Keyboard() {
  if (is_terminal_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

std::optional<char> Keyboard::pressed() const {
  pollfd key{STDIN_FILENO, POLLIN, 0};
  char character = 0;
  if (!is_terminal_ || ::poll(&key, 1, 0) != 1 || (key.revents & POLLIN) == 0 ||
      ::read(STDIN_FILENO, &character, 1) != 1)
    return std::nullopt;
  return character;
}

}  // namespace selfcal
