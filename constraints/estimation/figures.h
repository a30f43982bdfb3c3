// Figures within a sentence.
#pragma once

#include <cstdio>
#include <string>

namespace selfcal {

/// `format`, as printf's, with up to four figures in it; at most 199 characters.
inline std::string with_figures(const char* format, double a, double b = 0, double c = 0,
                                double d = 0) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b, c, d);
  return text;
}

}  // namespace selfcal
