// The lines BO_, SG_ and SIG_VALTYPE_ of DBC files.

#include "io/can/dbc.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "io/files/file.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostDbcBytes = 16 << 20;

/// What one line holds, from left to right; once something is missing all else is.
class Line {
 public:
  explicit Line(std::string_view text) : rest_(text) {}

  bool ok() const { return ok_; }
  bool empty() {
    blanks();
    return rest_.empty();
  }
  /// Passes over `mark`, with blanks before it.
  Line& mark(std::string_view mark) {
    blanks();
    ok_ = ok_ && rest_.starts_with(mark);
    if (ok_) rest_.remove_prefix(mark.size());
    return *this;
  }
  bool next_is(std::string_view mark) {
    blanks();
    return rest_.starts_with(mark);
  }
  std::string_view name() {
    blanks();
    const auto end = std::ranges::find_if_not(
        rest_, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    return taken(static_cast<std::size_t>(end - rest_.begin()));
  }
  template <class T>
  T number() {
    blanks();
    if (rest_.starts_with('+')) rest_.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc()) ok_ = false;
    taken(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }
  std::string_view quoted() {
    mark("\"");
    const std::size_t end = rest_.find('"');
    if (end == std::string_view::npos) ok_ = false;
    const std::string_view text = ok_ && end > 0 ? taken(end) : std::string_view();
    mark("\"");
    return text;
  }

 private:
  void blanks() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t'))
      rest_.remove_prefix(1);
  }
  std::string_view taken(std::size_t size) {
    if (size == 0) ok_ = false;
    if (!ok_) return {};
    const std::string_view text = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return text;
  }

  std::string_view rest_;
  bool ok_ = true;
};

CanId id_of(std::uint32_t number) {
  constexpr std::uint32_t kExtended = 0x80000000u;
  return {.value = number & ~kExtended, .extended = (number & kExtended) != 0};
}

class Parser {
 public:
  explicit Parser(const std::string& file) { dbc_.file = file; }

  /// What is wrong with the line; nothing when it is well or says nothing to us.
  std::optional<std::string> add(std::string_view text, int number) {
    Line line(text);
    // A text over several lines, as comments have it, may hold anything.
    const bool inside = quoted_;
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '"' && (i == 0 || text[i - 1] != '\\')) quoted_ = !quoted_;
    if (inside || line.empty()) return std::nullopt;
    if (line.next_is("BO_ ")) return message(line, number);
    if (line.next_is("SG_ ")) return signal(line, number);
    if (line.next_is("SIG_VALTYPE_ ")) return value_type(line);
    open_ = false;
    return std::nullopt;
  }

  Dbc finish() { return std::move(dbc_); }

 private:
  std::optional<std::string> message(Line& line, int number) {
    DbcMessage m;
    m.line = number;
    m.id = id_of(line.mark("BO_ ").number<std::uint32_t>());
    m.name = line.name();
    m.bytes = line.mark(":").number<int>();
    if (!line.ok()) return "expected BO_ ID NAME: BYTES SENDER";
    if (m.bytes < 0 || m.bytes > 64) return "message " + m.name + ": 0 to 64 bytes";
    // Vector's tools keep signals without a message here, under an id that no frame has.
    const bool orphans = m.name == "VECTOR__INDEPENDENT_SIG_MSG";
    if (!orphans && m.id.value > (m.id.extended ? CanId::kMostExtended : CanId::kMostStandard))
      return "message " + m.name + ": no CAN id";
    if (dbc_.find(m.name)) return "message " + m.name + " is there twice";
    dbc_.messages.push_back(std::move(m));
    open_ = true;
    return std::nullopt;
  }

  std::optional<std::string> signal(Line& line, int number) {
    if (!open_) return "SG_ without a BO_ before it";
    DbcSignal s;
    s.line = number;
    s.name = line.mark("SG_ ").name();
    if (!line.next_is(":")) {
      s.multiplexed = line.name() != "M";  // m0 or m1M; M is the switch, there in every frame
    }
    s.field.start = line.mark(":").number<int>();
    s.field.bits = line.mark("|").number<int>();
    const int order = line.mark("@").number<int>();
    s.field.is_signed = line.next_is("-");
    s.factor = line.mark(s.field.is_signed ? "-" : "+").mark("(").number<double>();
    s.offset = line.mark(",").number<double>();
    line.mark(")").mark("[").number<double>();
    line.mark("|").number<double>();
    s.unit = line.mark("]").quoted();
    if (!line.ok() || order < 0 || order > 1)
      return "expected SG_ NAME : START|BITS@ORDER SIGN (FACTOR,OFFSET) [MIN|MAX] \"UNIT\"";
    s.field.big_endian = order == 0;
    return keep(std::move(s));
  }

  std::optional<std::string> keep(DbcSignal s) {
    DbcMessage& message = dbc_.messages.back();
    const std::string what = "signal " + message.name + "." + s.name;
    if (s.field.bits < 1 || s.field.bits > 64) return what + ": 1 to 64 bits";
    if (s.field.start < 0 || s.field.start > 511) return what + ": starts at bit 0 to 511";
    const bool orphan = message.bytes == 0;
    if (!orphan && bytes_of(s.field) > message.bytes)
      return what + " reaches beyond the " + std::to_string(message.bytes) + " bytes of it";
    if (s.factor == 0 || !std::isfinite(s.factor) || !std::isfinite(s.offset))
      return what + ": a factor other than 0";
    if (find(message, s.name)) return what + " is there twice";
    message.signals.push_back(std::move(s));
    return std::nullopt;
  }

  std::optional<std::string> value_type(Line& line) {
    const CanId id = id_of(line.mark("SIG_VALTYPE_ ").number<std::uint32_t>());
    const std::string name(line.name());
    if (line.next_is(":")) line.mark(":");
    const int type = line.number<int>();
    if (!line.ok()) return "expected SIG_VALTYPE_ ID NAME : TYPE;";
    for (DbcMessage& message : dbc_.messages)
      for (DbcSignal& signal : message.signals)
        if (message.id == id && signal.name == name) signal.floating = type != 0;
    return std::nullopt;
  }

  Dbc dbc_;
  bool open_ = false;    ///< signals of a message may follow
  bool quoted_ = false;  ///< inside a text that began on an earlier line
};

}  // namespace

const DbcMessage* Dbc::find(std::string_view name) const {
  const auto found = std::ranges::find(messages, name, &DbcMessage::name);
  return found == messages.end() ? nullptr : &*found;
}

const DbcSignal* find(const DbcMessage& message, std::string_view name) {
  const auto found = std::ranges::find(message.signals, name, &DbcSignal::name);
  return found == message.signals.end() ? nullptr : &*found;
}

Result<Dbc> parse_dbc(std::string_view text, const std::string& file) {
  Parser parser(file);
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (const auto wrong = parser.add(line, number))
      return bad_input(file + ":" + std::to_string(number) + ": " + *wrong);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return parser.finish();
}

Result<Dbc> read_dbc(const std::filesystem::path& path) {
  const auto text = read_file(path, kMostDbcBytes);
  if (!text) return tl::unexpected(text.error());
  return parse_dbc(*text, path.string());
}

}  // namespace selfcal
