// The family of trigger transports.
#include "io/triggers.h"

namespace selfcal {

#define X(identifier) TriggerKindPtr make_##identifier(const TriggerEntry& entry);
#include "io/triggers.def"
#undef X

const std::vector<std::string_view>& trigger_kinds() {
  static const std::vector<std::string_view> kNames = {
#define X(identifier) #identifier,
#include "io/triggers.def"
#undef X
  };
  return kNames;
}

TriggerKindPtr make_trigger(std::string_view kind, const TriggerEntry& entry) {
#define X(identifier) \
  if (kind == #identifier) return make_##identifier(entry);
#include "io/triggers.def"
#undef X
  return nullptr;
}

}  // namespace selfcal
