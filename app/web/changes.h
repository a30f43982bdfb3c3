// By how much parameters change when a result is accepted or given up, and what its sets say.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "kinematics/robot.h"

namespace selfcal {

inline constexpr std::size_t kChangesShown = 12;

/// {"rows": [{"name", "unit", "change", "sigma"}, …], "count"} of the parameters whose values
/// differ from `from` to `to` (SI; 1 mm counts as 1 mrad), largest first, the first kChangesShown
/// of `count`; null for robots of different models. `result`, of the session of `to`, has the
/// sigmas; it may be empty.
nlohmann::ordered_json changes_between(const std::shared_ptr<const Robot>& from,
                                       const std::shared_ptr<const Robot>& to,
                                       const std::string& result);

/// The same of a result.json, from the maker's figures; null when it is none.
nlohmann::ordered_json changes_of_result(const std::string& result);

/// [{"name", "rows", "before", "after"}, …]: rms by set on rows kept aside, of what result.json
/// says under "residual"; null when it says nothing. It may come from anybody in the domain.
nlohmann::ordered_json sets_of_result(const nlohmann::ordered_json& result);

}  // namespace selfcal
