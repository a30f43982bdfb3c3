#include "io/models/urdf_tree.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

namespace selfcal {
namespace {

/// Keeps what urdfdom says while it lives, instead of letting it write to standard error.
class Listener : public console_bridge::OutputHandler {
 public:
  Listener() { console_bridge::useOutputHandler(this); }
  ~Listener() override { console_bridge::restorePreviousOutputHandler(); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) said_ += text + "\n";
  }
  const std::string& said() const { return said_; }

 private:
  std::string said_;
};

/// One line of a library's message.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

Result<urdf::ModelInterfaceSharedPtr> urdf_tree(const std::string& text, const UrdfLines& lines) {
  Listener listener;
  urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
  if (!model || !model->getRoot()) {
    const std::string why = first_line(listener.said());
    return bad_input(lines.place_of(listener.said()) +
                     ": urdfdom: " + (why.empty() ? "is no tree of links and joints" : why));
  }
  return model;
}

}  // namespace selfcal
