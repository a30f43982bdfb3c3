// What the server answers: the page, the state, and a command's reply.
#pragma once

#include <functional>

#include "app/web/board.h"
#include "app/web/server.h"
#include "io/messages.h"

namespace selfcal {

/// Sends a verb to a robot's service; the reply, or why none came.
using Commanding = std::function<Result<CommandReplyMessage>(
    const std::string& robot, const std::string& verb, const std::string& peer)>;

/// GET / the page; GET /state?robot=&epoch=&version= Board::changes; POST /command {"robot",
/// "verb", "seen": {"session", "active", "candidate"}} {"accepted", "why"}. `seen` is the status
/// for which the person decided: a command is refused (409) where it has changed since. One command
/// at a time (429). Neither `board` nor `command` may end before the handler.
WebHandler web_routes(const Board& board, Commanding command);

}  // namespace selfcal
