#include "app/web/board.h"

#include "app/report/live/message_json.h"

namespace selfcal {

void Board::put(const std::string& robot, const std::string& part, const Json& value) {
  std::string json = line_of(value);
  const std::lock_guard lock(mutex_);
  Text& text = topics_[robot].parts[part];
  if (text.json == json) return;
  text = {++version_, std::move(json)};
}

void Board::append(const std::string& robot, const std::string& list, const Json& value,
                   std::size_t most) {
  std::string json = line_of(value);
  const std::lock_guard lock(mutex_);
  auto& items = topics_[robot].lists[list].items;
  items.push_back({++version_, std::move(json)});
  if (items.size() > most) items.pop_front();
}

void Board::restart(const std::string& robot, const std::string& list) {
  const std::lock_guard lock(mutex_);
  topics_[robot].lists[list] = {++version_, {}};
}

void Board::drop(const std::string& robot) {
  const std::lock_guard lock(mutex_);
  topics_.erase(robot);
}

std::optional<Json> Board::part(const std::string& robot, const std::string& part) const {
  const std::lock_guard lock(mutex_);
  const auto topic = topics_.find(robot);
  if (topic == topics_.end()) return std::nullopt;
  const auto text = topic->second.parts.find(part);
  if (text == topic->second.parts.end()) return std::nullopt;
  return Json::parse(text->second.json);
}

std::string Board::parts_since(const Topic& topic, std::uint64_t version) {
  std::string json;
  for (const auto& [name, text] : topic.parts)
    if (text.version > version)
      json += (json.empty() ? "" : ",") + line_of(Json(name)) + ":" + text.json;
  return "{" + json + "}";
}

std::string Board::lists_since(const Topic& topic, std::uint64_t version) {
  std::string json;
  for (const auto& [name, list] : topic.lists) {
    const bool restarted = version == 0 || list.restarted > version;
    std::string items;
    for (const Text& item : list.items)
      if (item.version > version) items += (items.empty() ? "" : ",") + item.json;
    if (!restarted && items.empty()) continue;
    json += (json.empty() ? "" : ",") + line_of(Json(name)) +
            ":{\"restarted\":" + (restarted ? "true" : "false") + ",\"items\":[" + items + "]}";
  }
  return "{" + json + "}";
}

std::string Board::changes(const std::string& robot, const std::string& epoch,
                           std::uint64_t version) const {
  if (epoch != epoch_) version = 0;
  const std::lock_guard lock(mutex_);
  std::string json = "{\"epoch\":" + line_of(Json(epoch_)) +
                     ",\"version\":" + std::to_string(version_) +
                     ",\"robot\":" + line_of(Json(robot));
  if (const auto domain = topics_.find(""); domain != topics_.end())
    json += ",\"domain\":" + parts_since(domain->second, version);
  const auto topic = robot.empty() ? topics_.end() : topics_.find(robot);
  json += std::string(",\"known\":") + (topic != topics_.end() ? "true" : "false");
  if (topic != topics_.end())
    json += ",\"parts\":" + parts_since(topic->second, version) +
            ",\"lists\":" + lists_since(topic->second, version);
  return json + "}";
}

}  // namespace selfcal
