#include "app/commands/foreign/mended_model.h"

#include "app/commands/foreign/convert_notes.h"
#include "io/files/file.h"
#include "io/models/mjcf_like.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostMjcfBytes = std::size_t{16} << 20;

}  // namespace

Result<MjcfText> mjcf_of_robot(const Node& robot, const std::string& file) {
  const auto model = serial_model(robot, file, "mjcf");
  if (!model) return tl::unexpected(model.error());
  return mjcf_of(serial::with_usual_masses(*model), mjcf_effects(robot, *model));
}

Result<MjcfText> mjcf_mended(const Node& robot, const std::string& file, const std::string& like,
                             const std::string& tool) {
  const auto model = serial_model(robot, file, "mjcf");
  if (!model) return tl::unexpected(model.error());
  const auto text = read_file(like, kMostMjcfBytes);
  if (!text) return tl::unexpected(text.error());
  const auto read = read_mujoco(like, tool);
  if (!read) return tl::unexpected(read.error());
  const auto chain = corrected_by(*model, file, read->chain, like);
  if (!chain) return tl::unexpected(chain.error());
  return mjcf_like(*text, like, *read, *chain, *model, mjcf_effects(robot, *model));
}

}  // namespace selfcal
