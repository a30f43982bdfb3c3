// The page of an identification: what it says at the top, result.json, and the rows behind it.
#pragma once

#include "app/report/page/page.h"
#include "constraints/solution.h"

namespace selfcal {

/// The page's object. `result` is result.json without the covariance and the sets' own values;
/// `rows` are columns, evenly thinned where there are more than a page holds.
nlohmann::ordered_json identification_data(const PageSubject& subject, const Solution& solution);

}  // namespace selfcal
