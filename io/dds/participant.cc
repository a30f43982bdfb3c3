// Our presence in a DDS domain.

#include "io/dds/participant.h"

#include <dds/ddsrt/log.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>

#include "io/clock.h"
#include "io/dds/allowance.h"

namespace selfcal {
namespace {

/// What Cyclone has to say of strangers' packets goes to stderr as ever, but no faster than anybody
/// reads it: a flood of them would fill the journal.
void say_sparingly(void*, const dds_log_data_t* said) {
  static std::mutex mutex;
  static Allowance allowance(1, 50);
  static std::uint64_t left_out = 0;
  const std::scoped_lock lock(mutex);
  if (!allowance.take(monotonic_now())) {
    ++left_out;
    return;
  }
  if (left_out > 0)
    std::fprintf(stderr, "%llu lines of DDS left out\n", static_cast<unsigned long long>(left_out));
  left_out = 0;
  std::fprintf(stderr, "%.*s\n", static_cast<int>(said->size), said->message);
}

/// The domain as this process configures it, which all of its participants share. Null where
/// somebody else in the process has joined it before, whose configuration holds then.
Result<std::shared_ptr<DdsEntity>> domain_of(std::uint32_t number) {
  static std::mutex mutex;
  static std::map<std::uint32_t, std::weak_ptr<DdsEntity>> joined;
  const std::scoped_lock lock(mutex);
  if (joined.empty()) dds_set_log_sink(say_sparingly, nullptr);
  if (auto domain = joined[number].lock()) return domain;
  const char* given = std::getenv("CYCLONEDDS_URI");
  // Of two settings the later one holds.
  const std::string configuration = "<Internal><MaxSampleSize>" +
                                    std::to_string(kMostMessageBytes) +
                                    " B</MaxSampleSize></Internal>," + (given ? given : "");
  const dds_entity_t handle = dds_create_domain(number, configuration.c_str());
  if (handle == DDS_RETCODE_PRECONDITION_NOT_MET) return nullptr;
  if (handle < 0)
    return dds_failed("domain " + std::to_string(number) + " cannot be set up by CYCLONEDDS_URI",
                      handle);
  auto domain = std::make_shared<DdsEntity>(handle);
  joined[number] = domain;
  return domain;
}

}  // namespace

Result<int> domain_of_environment() {
  const char* const text = std::getenv("ROS_DOMAIN_ID");
  if (!text || !*text) return 0;
  const auto number = parse_number(text);
  if (number && *number >= 0 && *number <= kMostDdsDomain && *number == std::floor(*number))
    return static_cast<int>(*number);
  return bad_input("ROS_DOMAIN_ID is '" + std::string(text) + "', and must be 0 to " +
                   std::to_string(kMostDdsDomain));
}

Result<DdsParticipant> DdsParticipant::open(std::uint32_t domain, const std::string& name) {
  if (domain > kMostDdsDomain)
    return bad_input("DDS domain " + std::to_string(domain) + " is not between 0 and " +
                     std::to_string(kMostDdsDomain));
  auto joined = domain_of(domain);
  if (!joined) return tl::unexpected(joined.error());
  const std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)> qos(dds_create_qos(), dds_delete_qos);
  dds_qset_entity_name(qos.get(), name.c_str());
  const dds_entity_t handle = dds_create_participant(domain, qos.get(), nullptr);
  if (handle < 0)
    return dds_failed(
        "cannot join domain " + std::to_string(domain) +
            " (does CYCLONEDDS_URI name an interface that is there, and is there room "
            "for one more program on this computer, MaxAutoParticipantIndex?)",
        handle);
  return DdsParticipant(*std::move(joined), DdsEntity(handle));
}

}  // namespace selfcal
