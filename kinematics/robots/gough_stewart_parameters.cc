// Names, priors and the order of preference of a Gough-Stewart platform's parameters.
//
// The order decides which member of a dependent group is identified (Khalil and Dombre, 11.4.2.1):
// the centres of the joints, then the sensors' offsets, and last the coordinates that hold the
// frame of the platform and that of the base: where rows cannot see a frame, it is these that are
// not told.
#include <algorithm>

#include "kinematics/robots/gough_stewart.h"

namespace selfcal::gough_stewart {
namespace {

Parameter leg_parameter(const GoughStewart& model, int leg, int field) {
  static constexpr const char* kNames[kFields] = {"bx", "by", "bz", "px", "py", "pz", "offset"};
  Parameter p;
  p.name = kNames[field] + std::to_string(leg + 1);
  p.frame = leg_name(leg);
  p.field = kNames[field];
  take_figures(model, index(leg, field), kOwnTolerance, p);
  return p;
}

platform::Centres centres(const GoughStewart& model, int field) {
  platform::Centres all;
  for (int leg = 0; leg < kLegs; ++leg) all.col(leg) = model.nominal.segment<3>(index(leg, field));
  return all;
}

/// Indices of the coordinates that hold the frame of the centres at `field`.
std::vector<int> holding(const GoughStewart& model, int field) {
  std::vector<int> list;
  for (const int at : platform::frame_coordinates(centres(model, field)))
    list.push_back(index(at / 3, field + at % 3));
  return list;
}

}  // namespace

std::vector<Parameter> parameters(const GoughStewart& model) {
  std::vector<Parameter> list;
  for (int leg = 0; leg < kLegs; ++leg)
    for (int field = 0; field < kFields; ++field) list.push_back(leg_parameter(model, leg, field));
  return list;
}

std::vector<int> preference(const GoughStewart& model) {
  std::vector<int> last = holding(model, kPlatform);
  for (const int each : holding(model, kBase)) last.push_back(each);
  std::vector<int> order;
  const auto take = [&](int field) {
    for (int leg = 0; leg < kLegs; ++leg)
      if (const int at = index(leg, field); std::find(last.begin(), last.end(), at) == last.end())
        order.push_back(at);
  };
  for (int field = kPlatform; field < kPlatform + 3; ++field) take(field);
  for (int field = kBase; field < kBase + 3; ++field) take(field);
  take(kOffset);
  order.insert(order.end(), last.begin(), last.end());
  return order;
}

}  // namespace selfcal::gough_stewart
