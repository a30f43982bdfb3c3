#include "app/commands/support/user.h"

#include <pwd.h>
#include <unistd.h>

#include <array>

namespace selfcal {

std::string user_at_host() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const passwd* user = ::getpwuid(::geteuid());
  const std::string name = user ? user->pw_name : std::to_string(::geteuid());
  return name + "@" + host.data();
}

}  // namespace selfcal
