// Our presence in a DDS domain.

#include "io/dds/participant.h"

#include <memory>

namespace selfcal {

Result<DdsParticipant> DdsParticipant::open(std::uint32_t domain, const std::string& name) {
  if (domain > kMostDdsDomain)
    return bad_input("DDS domain " + std::to_string(domain) + " is not between 0 and " +
                     std::to_string(kMostDdsDomain));
  const std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)> qos(dds_create_qos(), dds_delete_qos);
  dds_qset_entity_name(qos.get(), name.c_str());
  const dds_entity_t handle = dds_create_participant(domain, qos.get(), nullptr);
  if (handle < 0)
    return dds_failed(
        "cannot join domain " + std::to_string(domain) +
            " (does CYCLONEDDS_URI name an interface that is there, and is there room "
            "for one more program on this computer, MaxAutoParticipantIndex?)",
        handle);
  return DdsParticipant(DdsEntity(handle));
}

}  // namespace selfcal
