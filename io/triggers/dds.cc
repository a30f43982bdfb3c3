// The trigger from a topic of stamped levels (io/dds/trigger.h), stamped by the sender.
//
//   key              default             range  meaning
//   topic            selfcal/ID/trigger         selfcal_msgs/StampedBool

#include "io/dds/context.h"
#include "io/dds/names.h"
#include "io/dds/senders.h"
#include "io/dds/trigger.h"
#include "io/triggers.h"

namespace selfcal {
namespace {

class DdsTriggerKind final : public TriggerKind {
 public:
  explicit DdsTriggerKind(DdsTriggerConfig config) : config_(std::move(config)) {}

  StampedBy stamped_by() const override { return StampedBy::sender; }
  std::string source() const override { return "topic " + config_.topic; }
  Result<std::unique_ptr<TouchTrigger>> open(const PortContext& context) const override {
    DdsTriggerConfig config = config_;
    config.silence = context.silence;
    return DdsTrigger::open(context.dds.participant, config, context.dds.mapping, context.wakeup);
  }
  Result<std::unique_ptr<TriggerSender>> open_sender(const RobotContext& context) const override {
    return DdsTriggerSender::open(context.dds.participant, config_.topic, context.wakeup);
  }

 private:
  DdsTriggerConfig config_;
};

}  // namespace

TriggerKindPtr make_dds(const TriggerEntry& entry) {
  Fields fields(entry.node, "trigger", entry.problems);
  DdsTriggerConfig config;
  config.topic = fields.text("topic", "selfcal/" + ros_name(entry.robot) + "/trigger");
  fields.refuse_unknown();
  return std::make_shared<DdsTriggerKind>(std::move(config));
}

}  // namespace selfcal
