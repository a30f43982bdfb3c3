// Names to indices by hash tables that take string_views, so that a row allocates only for a new
// name.
#include "io/files/row_labels.h"

#include <cctype>
#include <map>

#include "kinematics/readable.h"

namespace selfcal {

LabelReader::LabelReader(std::vector<Set>& sets) : sets_(sets) {
  for (std::size_t i = 0; i < sets.size(); ++i) {
    set_index_.emplace(sets[i].name, i);
    SetState& state = states_.emplace_back();
    for (const std::string& group : sets[i].groups) {
      state.groups.emplace(group, static_cast<int>(state.groups.size()));
    }
    state.group_rows.resize(sets[i].groups.size());
  }
}

tl::expected<Labels, RowFault> LabelReader::read(Cells cells, int row) {
  Labels labels;
  if (auto fault = read_set(cells, labels)) return tl::unexpected(std::move(*fault));
  if (auto fault = read_part(cells, labels)) return tl::unexpected(std::move(*fault));
  if (auto fault = read_repeat(cells, row, labels)) return tl::unexpected(std::move(*fault));
  if (auto fault = read_group(cells, labels)) return tl::unexpected(*fault);
  count(labels);
  return labels;
}

std::optional<RowFault> LabelReader::read_set(Cells cells, Labels& labels) const {
  if (!layout_->set) return std::nullopt;
  const std::string_view name = cells[*layout_->set];
  const auto found = set_index_.find(name);
  if (found != set_index_.end()) {
    labels.set = found->second;
    return std::nullopt;
  }
  std::string known;
  for (const Set& set : sets_) known += (known.empty() ? "" : ", ") + set.name;
  return RowFault{"no set is called '" + std::string(name) + "'; known: " + known, layout_->set};
}

std::optional<RowFault> LabelReader::read_part(Cells cells, Labels& labels) const {
  if (!layout_->part) return std::nullopt;
  const std::string_view part = cells[*layout_->part];
  labels.check = part == "check";
  if (labels.check || part.empty() || part == "fit") return std::nullopt;
  return RowFault{"expected fit, check or nothing, got '" + std::string(part) + "'", layout_->part};
}

std::optional<RowFault> LabelReader::read_repeat(Cells cells, int row, Labels& labels) {
  if (!layout_->repeat || cells[*layout_->repeat].empty()) return std::nullopt;
  const std::string_view text = cells[*layout_->repeat];
  auto found = repeats_.find(text);
  if (found == repeats_.end()) {
    const int id = static_cast<int>(repeats_.size());
    found = repeats_.emplace(text, Repeat{id, labels.check, row}).first;
  }
  labels.repeat = found->second.id;
  if (found->second.check == labels.check) return std::nullopt;
  return RowFault{"repeats of '" + std::string(text) + "' must be of one part, and row " +
                      std::to_string(found->second.first_row) + " is of the other",
                  layout_->repeat};
}

std::optional<RowFault> LabelReader::read_group(Cells cells, Labels& labels) {
  if (!layout_->group || cells[*layout_->group].empty()) return std::nullopt;
  const std::string_view name = cells[*layout_->group];
  if (has_control(name)) return RowFault{"a name with a control character", layout_->group};
  SetState& state = states_[labels.set];
  auto found = state.groups.find(name);
  if (found == state.groups.end()) {
    std::vector<std::string>& groups = sets_[labels.set].groups;
    found = state.groups.emplace(name, static_cast<int>(groups.size())).first;
    groups.emplace_back(name);
    state.group_rows.push_back(0);
  }
  labels.group = found->second;
  return std::nullopt;
}

void LabelReader::count(Labels& labels) {
  SetState& state = states_[labels.set];
  ++state.rows;
  int& rows =
      labels.group < 0 ? state.ungrouped : state.group_rows[static_cast<std::size_t>(labels.group)];
  labels.first_of_group = rows++ == 0;
}

std::optional<std::string> LabelReader::group_without_rows() const {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    for (std::size_t k = 0; k < states_[i].group_rows.size(); ++k) {
      if (states_[i].group_rows[k] > 0) continue;
      return "set '" + sets_[i].name + "' names group '" + sets_[i].groups[k] +
             "', which has no rows";
    }
  }
  return std::nullopt;
}

std::vector<std::string> LabelReader::sets_without_rows() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (states_[i].rows == 0) names.push_back(sets_[i].name);
  }
  return names;
}

std::vector<std::string> LabelReader::groups_alike() const {
  std::vector<std::string> sentences;
  for (const Set& set : sets_) {
    std::map<std::string, std::string> known;  // by what is left of it
    for (const std::string& name : set.groups) {
      std::string bare;
      for (const char each : name)
        if (each != ' ' && each != '-' && each != '_')
          bare += static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
      const auto [other, first] = known.try_emplace(std::move(bare), name);
      if (!first)
        sentences.push_back("set '" + set.name + "': the groups '" + other->second + "' and '" +
                            name + "' differ in capitals, blanks or dashes alone: are they one?");
    }
  }
  return sentences;
}

}  // namespace selfcal
