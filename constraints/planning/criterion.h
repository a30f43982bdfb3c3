// What a choice of configurations is judged by.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string_view>
#include <vector>

namespace selfcal {

/// The end position's expected sigma, or an observability index of the literature (see
/// constraints/identifiability/observability.h); the condition number orders choices as o2 does.
enum class Criterion { sigma, o1, o2, o3, o4, o5, condition };

std::string_view to_string(Criterion criterion);
/// The criterion called `name`; nothing where there is none.
std::optional<Criterion> criterion_of(std::string_view name);
std::vector<std::string_view> criterion_names();
/// It is made of the eigenvalues of the covariance: neither the end position's nor the determinant.
bool is_spectral(Criterion criterion);
/// Of such a one the merit of the eigenvalues (ascending) of C, the larger the better, -infinity
/// where one is not positive; `slope`, where asked for, has its derivatives to them.
double spectral_merit(Criterion criterion, const Eigen::VectorXd& values, Eigen::VectorXd* slope);

/// A choice has the information H = prior + sum WᵀW of its m columns and C = H^-1.
struct Objective {
  Criterion criterion = Criterion::o1;
  /// m x m, what is known before any candidate; without rows: nothing is. Of `sigma` it must be
  /// positive definite.
  Eigen::MatrixXd prior = {};
  /// m x m, of `sigma`, which is sqrt(trace(weight C)).
  Eigen::MatrixXd weight = {};
  /// As many of the last columns are unknowns of no interest: indices are of the others, with these
  /// projected out.
  Eigen::Index nuisance = 0;
};

}  // namespace selfcal
