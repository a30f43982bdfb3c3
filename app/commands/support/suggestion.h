// What was probably meant by a word of the command line that the program does not know.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace selfcal {

/// A sentence on the first word of a command line that names no subcommand or option of `app`, with
/// the nearest that does; empty where all are known. `arguments`: without the program's name.
std::string unknown_word(const CLI::App& app, const std::vector<std::string>& arguments);

}  // namespace selfcal
