// The object stands in a <script type="application/json">, in which only "<" could end or change
// what the browser reads; JSON may write it as \u003c.
#include "app/report/page/page.h"

#include "app/report/format.h"
#include "io/files/robot_file.h"

extern "C" {
extern const char selfcal_page_begin[];  // NOLINT: names of the assembler's
extern const char selfcal_page_end[];
}

namespace selfcal {
namespace {

constexpr std::string_view kPlace = "{{data}}";

std::string without_tags(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json)
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  return text;
}

}  // namespace

nlohmann::ordered_json page_begin(const char* kind, const std::string& robot,
                                  std::int64_t unix_ms) {
  return {{"kind", kind},
          {"version", SELFCAL_VERSION},
          {"made", date_time(unix_ms)},
          {"robot", {{"name", robot}}}};
}

nlohmann::ordered_json page_begin(const char* kind, const PageSubject& subject) {
  nlohmann::ordered_json json = page_begin(kind, subject.robot.name(), subject.unix_ms);
  json["robot"]["kind"] = subject.robot.kind();
  json["robot"]["joints"] = nlohmann::ordered_json::array();
  for (const Joint& joint : subject.robot.joints())
    json["robot"]["joints"].push_back({{"name", joint.name}, {"unit", unit(joint.quantity)}});
  json["robot"]["model_hash"] = model_hash(subject.robot);
  json["data"] = {{"name", subject.name}, {"rows", subject.data.rows.rows()}};
  json["data"]["sets"] = nlohmann::ordered_json::array();
  for (const Set& set : subject.data.sets)
    json["data"]["sets"].push_back({{"name", set.name}, {"method", set.method->name()}});
  json["data"]["target"] = subject.data.target;
  return json;
}

std::string page_of(const nlohmann::ordered_json& data) {
  // cppcheck-suppress comparePointers  // the assembler's labels are of one object
  const auto size = static_cast<std::size_t>(selfcal_page_end - selfcal_page_begin);
  const std::string_view page(selfcal_page_begin, size);
  const std::size_t at = page.find(kPlace);
  std::string text(page.substr(0, at));
  // What users wrote may be no UTF-8: such bytes come as the replacement character.
  text += without_tags(data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  return text.append(page.substr(at + kPlace.size()));
}

}  // namespace selfcal
