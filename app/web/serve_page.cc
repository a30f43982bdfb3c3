#include "app/web/serve_page.h"

#include <unistd.h>

#include <array>
#include <cstdio>

#include "app/report/format.h"
#include "app/web/domain_watch.h"
#include "app/web/gate.h"
#include "app/web/routes.h"
#include "app/web/token.h"
#include "io/dds/clients/commander.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kTurn = kSecond / 10;       // the longest wait: a signal is obeyed so soon
constexpr Nanoseconds kReplyLimit = 5 * kSecond;  // to a command
constexpr Nanoseconds kReplySlice = 300 * kMillisecond;

/// This computer's name and its first part, in lower case as in Host.
std::vector<std::string> own_names() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) return {};
  const std::string name = host_of(host.data());
  return {name, name + ".local", name.substr(0, name.find('.'))};
}

Result<std::string> token_for(const PageOptions& options) {
  if (!options.token_file.empty()) return read_token(options.token_file);
  if (options.address.loopback) return std::string();
  // What goes anywhere else is kept: in a journal, in a file, by who reads them.
  if (isatty(STDERR_FILENO) == 0)
    return tl::unexpected<Failure>(
        {kMisused,
         "others reach " + options.address.url() +
             ", so that it asks for a token, and one that is made is printed to a terminal alone: "
             "give one by --token FILE (umask 077; openssl rand -hex 16 > FILE)"});
  return new_token();
}

/// Says the command again until there is a reply, as long as nobody tells us to stop.
Result<CommandReplyMessage> ask_service(const DdsParticipant& participant, const std::string& robot,
                                        const CommandMessage& message,
                                        const std::function<bool()>& stop) {
  const auto commander = DdsCommander::open(participant, robot);
  if (!commander) return tl::unexpected(commander.error());
  const Nanoseconds end = monotonic_now() + kReplyLimit;
  while (true) {
    auto reply = (*commander)->send(message, kReplySlice);
    if (reply || monotonic_now() >= end || stop()) return reply;
  }
}

void say_where(const WebAddress& address, const PageOptions& options, const std::string& token) {
  const bool own = !token.empty() && options.token_file.empty();
  const std::string url = address.url() + (own ? "#token=" + token : "");
  std::fprintf(stderr, "selfcal: watching %s in DDS domain %d, topics rt/selfcal/%s/...\n",
               options.robot.empty() ? "every robot" : options.robot.c_str(), options.domain,
               options.robot.empty() ? "ROBOT" : options.robot.c_str());
  std::fprintf(stderr, "selfcal: the page is at %s%s\n", url.c_str(),
               !token.empty() && !own ? ", and asks for the token" : "");
  std::fprintf(stderr, "selfcal: %s\n",
               options.commands ? "who reaches it may command the robots"
                                : "it only shows (--allow-commands)");
  if (!address.loopback)
    std::fprintf(stderr,
                 "selfcal: what goes over the network is not encrypted; behind a proxy that speaks "
                 "TLS, or through ssh, it is\n");
}

}  // namespace

Result<void> serve_page(const DdsParticipant& participant, const PageOptions& options,
                        const std::function<bool()>& stop) {
  const auto token = token_for(options);
  if (!token) return tl::unexpected(token.error());
  const auto epoch = new_token();
  if (!epoch) return tl::unexpected(epoch.error());
  Wakeup wakeup;
  Board board(*epoch);
  board.put("", "server", {{"version", SELFCAL_VERSION}, {"commands", options.commands}});
  std::vector<std::unique_ptr<CellView>> cells;
  for (const std::string& config : options.configs) {
    auto cell = CellView::open(config, participant, wakeup);
    if (!cell) return tl::unexpected(cell.error());
    if (const Config& of = (*cell)->config(); of.domain != options.domain)
      return tl::unexpected<Failure>(
          {kMisused, printed("%s: robot %s is in DDS domain %d, and the page watches domain %d; "
                             "--domain %d",
                             config.c_str(), of.id.c_str(), of.domain, options.domain, of.domain)});
    cells.push_back(*std::move(cell));
  }
  const auto watch = DomainWatch::open(participant, options.robot, std::move(cells), wakeup, board);
  if (!watch) return tl::unexpected(watch.error());
  const auto command = [&](const std::string& robot, const std::string& verb,
                           const std::string& peer) {
    const CommandMessage message{.id = DdsCommander::new_id(),
                                 .verb = verb,
                                 .from = options.from + " (page, from " + peer + ")"};
    return ask_service(participant, robot, message, stop);
  };
  const auto server = WebServer::open(options.address, {options.commands, *token, own_names()},
                                      ServerLimits{}, web_routes(board, command));
  if (!server) return tl::unexpected(server.error());
  say_where((*server)->address(), options, *token);
  while (!stop()) {
    if (auto taken = (*watch)->take(); !taken) return taken;
    wakeup.wait(kTurn);
  }
  return {};
}

}  // namespace selfcal
