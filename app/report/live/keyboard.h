// Keys of the person at the terminal, one by one, without waiting for the end of a line.
#pragma once

#include <termios.h>

#include <optional>

namespace selfcal {

/// While it lives, keys come one by one and are not shown; ^C still interrupts. Where standard
/// input is no terminal no key ever comes.
class Keyboard {
 public:
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// The next key pressed since it was last asked, if any; never waits.
  std::optional<char> pressed() const;

 private:
  bool is_terminal_ = false;
  termios before_{};
};

}  // namespace selfcal
