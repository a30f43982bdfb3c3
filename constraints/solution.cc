#include "constraints/solution.h"

namespace selfcal {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::identified:
      return "identified";
    case Status::grouped:
      return "grouped";
    case Status::no_effect:
      return "no-effect";
    case Status::held:
      return "held";
    case Status::fixed:
      return "fixed";
  }
  return "";
}

std::string_view to_string(Answer answer) {
  switch (answer) {
    case Answer::improved:
      return "improved";
    case Answer::not_improved:
      return "not-improved";
    case Answer::not_determined:
      return "not-determined";
  }
  return "";
}

}  // namespace selfcal
