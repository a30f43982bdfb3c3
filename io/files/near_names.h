// What a name that is not there was probably meant to be.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace selfcal {

/// The one of `known` that is fewest slips of a typist away (a letter too many, too few, wrong, or
/// two exchanged), empty where every one is more than a third of the word away.
std::string nearest_word(std::string_view typed, const std::vector<std::string>& known);

/// What a file has in place of the column `missing`: the first of its `columns`, and the nearest of
/// those that are `unknown`.
std::string columns_instead(std::string_view missing, const std::vector<std::string>& columns,
                            const std::vector<std::string>& unknown);

}  // namespace selfcal
