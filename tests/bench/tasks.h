// The tasks that are measured, a source each.
#pragma once

#include <benchmark/benchmark.h>

#include "constraints/equations/equations.h"
#include "tests/bench/arm.h"

namespace selfcal::bench {

/// Each adds its tasks to Google Benchmark's.
void add_jacobians();
void add_identifications();
void add_choices();
void add_growth();

/// What it is to weigh every row as measured.
inline Weighting equal_weights(const Task& task) {
  Weighting weighting;
  weighting.scale = {{kMeasured, kMeasured}};
  weighting.outlier.assign(task.data.rows.set.size(), 0);
  return weighting;
}

template <class Function>
benchmark::internal::Benchmark* add_task(const std::string& name, Function function) {
  return benchmark::RegisterBenchmark(name.c_str(), function);
}

}  // namespace selfcal::bench
