// The family of encoder transports.
#include "io/encoders.h"

namespace selfcal {

#define X(identifier) EncoderKindPtr make_##identifier(const EncoderEntry& entry);
#include "io/encoders.def"
#undef X

const std::vector<std::string_view>& encoder_kinds() {
  static const std::vector<std::string_view> kNames = {
#define X(identifier) #identifier,
#include "io/encoders.def"
#undef X
  };
  return kNames;
}

EncoderKindPtr make_encoders(std::string_view kind, const EncoderEntry& entry) {
#define X(identifier) \
  if (kind == #identifier) return make_##identifier(entry);
#include "io/encoders.def"
#undef X
  return nullptr;
}

}  // namespace selfcal
