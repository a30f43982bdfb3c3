// Whether bytes are text, and text in UTF-8 whatever a file's byte order mark says.
#pragma once

#include <string>
#include <string_view>

namespace selfcal {

/// True for UTF-8 (RFC 3629: no overlong forms, no surrogates) without zero bytes. What is read as
/// text must be: it ends up in names, and names in JSON.
bool is_text(std::string_view bytes);

/// What a text begins with, after its byte order mark and blanks: '<' of XML; 0 of an empty one.
char first_of(std::string_view text);

/// Pieces of a file as UTF-8 without a byte order mark: UTF-16 behind either of its marks (RFC
/// 2781, as spreadsheets and trackers export it) is converted, anything else is as it stands. What
/// is no UTF-16 becomes what is no text.
class Utf8Pieces {
 public:
  /// Valid until the next piece; what has not come as a whole character waits for it.
  std::string_view take(std::string_view piece);

  /// The file's end is no character's middle.
  bool whole() const { return rest_.empty() && high_ == 0; }

 private:
  enum class Form { unknown, as_it_stands, little_endian, big_endian };

  void take_unit(unsigned unit);

  Form form_ = Form::unknown;
  std::string rest_, text_;
  unsigned high_ = 0;  // the first unit of a pair
};

}  // namespace selfcal
