// Lines redrawn in place on a terminal. What stands above them stays, until the terminal changes
// its size: it breaks and moves lines then as it likes, and the screen begins anew. Nothing is to
// be restored at the end.
#pragma once

#include <string>
#include <vector>

#include "app/report/live/monitor_view.h"

namespace selfcal {

struct ScreenSize {
  int columns = 80, rows = 24;
  bool operator==(const ScreenSize&) const = default;
};

class Screen {
 public:
  /// The size of the terminal now; 80 by 24 when it does not say.
  static ScreenSize size();

  /// Draws `lines`, made for `size`, over those drawn before.
  void draw(const std::vector<Line>& lines, const ScreenSize& size);

 private:
  int drawn_ = 0;  ///< lines
  ScreenSize size_;
};

}  // namespace selfcal
