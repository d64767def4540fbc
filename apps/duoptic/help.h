// What a command says of itself, read from its declared options: the help; manual.cpp makes other forms of it.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "command.h"

namespace duo::app {

/// Columns of a line of help: those of the terminal, elsewhere COLUMNS or 80; 40 .. 100.
int help_columns();

/// The help of a command; with `all` also the parameters of the matchers.
std::string help_text(const CLI::App& command, int columns, bool all);

/// What no command or option is called among the words after the program's name, and what was perhaps meant: one line. Empty:
/// all are known.
std::string unknown_word(const CLI::App& duoptic, std::span<const std::string> words);

/// "eval clip"; "" for the program itself.
std::string name_of(const CLI::App& command);
std::vector<const CLI::App*> commands_of(const CLI::App& command);
std::vector<const CLI::Option*> options_of(const CLI::App& command, bool positional);

/// "duoptic depth [OPTIONS] LEFT [RIGHT]"
std::string usage_of(const CLI::App& command);
/// "-o, --output FILE"
std::string signature_of(const CLI::Option& option);
/// With its default.
std::string description_of(const CLI::Option& option);
/// The words that it takes, where only those will do.
std::vector<std::string> choices_of(const CLI::Option& option);

/// Every parameter of every matcher, name and meaning, of a command that sets them.
std::vector<std::pair<std::string, std::string>> parameters_of(const CLI::App& command);

/// Footers as they are written: lines that begin with spaces are examples, one that ends with \ goes on; the others flow.
struct Paragraph {
  bool example = false;
  std::string text, note;  // of an example, what follows it after three spaces
};
std::vector<Paragraph> paragraphs_of(const std::string& text);

}  // namespace duo::app
