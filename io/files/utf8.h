// Whether bytes are text.
#pragma once

#include <string_view>

namespace selfcal {

/// True for UTF-8 (RFC 3629: no overlong forms, no surrogates) without zero bytes. What is read as
/// text must be: it ends up in names, and names in JSON.
bool is_text(std::string_view bytes);

}  // namespace selfcal
