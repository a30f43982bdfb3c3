#include "io/ports.h"

namespace selfcal {

std::string_view to_string(MoveKind kind) {
  switch (kind) {
    case MoveKind::travel:
      return "travel";
    case MoveKind::touch:
      return "touch";
    case MoveKind::seat:
      return "seat";
    case MoveKind::retract:
      return "retract";
    case MoveKind::lock:
      return "lock";
    case MoveKind::visit:
      return "visit";
    case MoveKind::release:
      return "release";
  }
  return "";
}

std::string_view to_string(MotionReply::Outcome outcome) {
  switch (outcome) {
    case MotionReply::Outcome::accepted:
      return "accepted";
    case MotionReply::Outcome::done:
      return "done";
    case MotionReply::Outcome::stopped:
      return "stopped";
    case MotionReply::Outcome::refused:
      return "refused";
  }
  return "";
}

}  // namespace selfcal
