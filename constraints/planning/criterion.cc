#include "constraints/planning/criterion.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace selfcal {
namespace {

constexpr std::array<std::pair<Criterion, std::string_view>, 7> kCriteria = {
    {{Criterion::sigma, "sigma"},
     {Criterion::o1, "o1"},
     {Criterion::o2, "o2"},
     {Criterion::o3, "o3"},
     {Criterion::o4, "o4"},
     {Criterion::o5, "o5"},
     {Criterion::condition, "condition"}}};

}  // namespace

std::string_view to_string(Criterion criterion) {
  return kCriteria[static_cast<std::size_t>(criterion)].second;
}

std::optional<Criterion> criterion_of(std::string_view name) {
  for (const auto& [criterion, text] : kCriteria)
    if (text == name) return criterion;
  return std::nullopt;
}

std::vector<std::string_view> criterion_names() {
  std::vector<std::string_view> names;
  for (const auto& each : kCriteria) names.push_back(each.second);
  return names;
}

bool is_spectral(Criterion criterion) {
  return criterion != Criterion::sigma && criterion != Criterion::o1;
}

double spectral_merit(Criterion criterion, const Eigen::VectorXd& values, Eigen::VectorXd* slope) {
  const Eigen::Index last = values.size() - 1;
  if (!(values[0] > 0)) return -std::numeric_limits<double>::infinity();
  if (slope) slope->setZero(values.size());
  const auto add = [&](Eigen::Index i, double factor) {
    if (slope) (*slope)[i] += factor / values[i];
    return factor * std::log(values[i]);
  };
  switch (criterion) {
    case Criterion::o3:
      return add(last, -0.5);
    case Criterion::o4:
      return add(last, -1) + add(0, 0.5);
    case Criterion::o5: {
      const double sum = values.cwiseSqrt().sum();
      if (slope) *slope = -0.5 / sum * values.cwiseSqrt().cwiseInverse();
      return -std::log(sum);
    }
    default:
      return add(last, -0.5) + add(0, 0.5);
  }
}

}  // namespace selfcal
