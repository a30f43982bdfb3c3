// How everything that touches the outside world says that it could not.
//
// A Failure is the world's doing and carries what the user is told: a file that breaks a rule, a
// device that is silent. A bug never becomes a Failure, and bad measurements are no failure at all
// but an answer of the identification.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "kinematics/description.h"
#include "kinematics/expects.h"

namespace selfcal {

/// Exit statuses of the program that a Failure may ask for.
inline constexpr int kBadInput = 3;
inline constexpr int kDeviceFailed = 4;  ///< a device, a disk or the communication

struct Failure {
  int exit_status = kBadInput;
  std::string what;  ///< one sentence with the file and the line or row
};

template <class T>
using Result = tl::expected<T, Failure>;

inline tl::unexpected<Failure> bad_input(std::string what) {
  return tl::unexpected<Failure>({kBadInput, std::move(what)});
}

/// The first of the problems, of which there must be one.
inline tl::unexpected<Failure> bad_input(const Problems& problems) {
  expects(problems.any(), "what is refused has a problem");
  return bad_input(problems.list.front());
}

inline tl::unexpected<Failure> device_failed(std::string what) {
  return tl::unexpected<Failure>({kDeviceFailed, std::move(what)});
}

}  // namespace selfcal
