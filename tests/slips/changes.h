// Changes of a data set's files, each a slip that a person makes.
#pragma once

#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "tests/slips/files.h"

namespace selfcal::slips {

inline constexpr double kDegree = std::numbers::pi / 180;

using Numbers = std::vector<double>;
using Make = std::function<void(Files&)>;

inline const std::vector<std::string> kSix = {"q1", "q2", "q3", "q4", "q5", "q6"};

Make reading(const std::string& column, const std::function<double(double)>& of);
Make sign(const std::string& column);
Make factor(const std::string& column, double by);
Make offset(const std::string& column, double degrees);
Make exchanged(const std::string& a, const std::string& b);
Make every_reading(const std::function<double(double)>& of);
Make place(const std::function<void(Numbers&, double)>& change);
Make position_times(double factor);
Make moved_from_half(const Numbers& by);
Make turned_from_half(double degrees);
Make false_places(double share, double size);
/// The stylus was exchanged for one whose tip is elsewhere in the last frame.
Make other_tip_from_half(const Numbers& tip);
/// The measured columns of the rows, given to other rows.
Make measured_elsewhere(bool by_one);
Make twice_or_more(int times);
Make temperature(const std::function<double(double)>& of);
Make shuffled_times();
Make wrench(const std::vector<std::string>& columns);
Make data_set(const std::string& what, const std::string& by);
Make robot(const std::string& what, const std::string& by);
Make first_rows(std::size_t count);
Make on_one_line();
Make renamed(const std::string& column, const std::string& from, const std::string& to);
Make rounded(const std::vector<std::string>& columns, double step);

}  // namespace selfcal::slips
