// A report as a page: one HTML file that needs nothing else, with its data as one JSON object.
//
// The template (page.html, page.css, the scripts, Chart.js and three.js) is assembled when the
// program is built; scripts in the page draw what the object holds, and leave out what it lacks.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"

namespace selfcal {

/// What a page is about.
struct PageSubject {
  const Robot& robot;
  const DataSet& data;
  std::string name;          ///< of the data set or session
  std::int64_t unix_ms = 0;  ///< when the page is made
};

/// Who made the page and when, robot, data and model hash: how every page's object begins. `kind`
/// is the page's: "identification", "diagnosis", "history".
nlohmann::ordered_json page_begin(const char* kind, const PageSubject& subject);
/// The same of a page without data, of the robot called `robot`.
nlohmann::ordered_json page_begin(const char* kind, const std::string& robot, std::int64_t unix_ms);

/// The page that shows `data`. Nothing of what it holds, whatever users have called their things,
/// is read as HTML or script.
std::string page_of(const nlohmann::ordered_json& data);

}  // namespace selfcal
