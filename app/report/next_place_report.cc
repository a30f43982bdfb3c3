#include "app/report/next_place_report.h"

#include "app/report/format.h"
#include "io/files/json_parts.h"

namespace selfcal {
namespace {

constexpr std::size_t kToldPlaces = 5;

std::string place_report(const Eigen::Vector3d& v) {
  return printed("[%.3f, %.3f, %.3f]", v.x(), v.y(), v.z());
}

}  // namespace

std::string next_place_report(const NextRequest& request, const NextPlaces& next) {
  const std::string method(request.further.method->name());
  if (!next.problem.empty()) return "no further " + method + ": " + next.problem + "\n";
  std::string text = printed(
      "end position known to %s mm; with %d configurations more of what there is %s mm, of a "
      "further "
      "%s beside it\n",
      mm(next.sigma_now).c_str(), request.count, mm(next.sigma_same).c_str(), method.c_str());
  for (std::size_t i = 0; i < next.places.size() && i < kToldPlaces; ++i) {
    const NextPlace& each = next.places[i];
    text += "  " + mm(each.sigma) + " mm at " + place_report(each.centre);
    if (each.normal.norm() > 0)
      text +=
          " and " + printed("%.2f", each.radius) + " m around, normal " + place_report(each.normal);
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json next_json(const NextPlaces& next) {
  nlohmann::ordered_json json{{"problem", next.problem},
                              {"sigma_now", finite(next.sigma_now)},
                              {"sigma_same", finite(next.sigma_same)}};
  json["places"] = array_of(next.places, [](const NextPlace& each) {
    return nlohmann::ordered_json{
        {"sigma", finite(each.sigma)},
        {"centre", array_of(each.centre, finite)},
        {"normal",
         each.normal.norm() > 0 ? array_of(each.normal, finite) : nlohmann::ordered_json(nullptr)},
        {"radius", finite(each.radius)}};
  });
  return json;
}

}  // namespace selfcal
