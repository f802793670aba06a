#include "tests/architecture/source_rules.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "tests/architecture/loop_rules.h"

namespace fleetplan::architecture {
namespace {

using std::string_view;

/// What the files of one layer may include and must not use.
struct Layer {
  string_view folder;
  std::vector<string_view> own;          // allowed beginnings of "quoted" includes
  std::vector<string_view> third_party;  // allowed beginnings of <angle> includes beside the standard library
  bool any_third_party = false;
  std::vector<string_view> forbidden;  // identifiers
  bool is_same_everywhere = false;     // whether it must not use kOtherEverywhere, either
};

/// Functions whose last digits differ between machines; core/geometry/elementary_functions.h has others.
constexpr std::array<string_view, 22> kOtherEverywhere{
    "std::sin",   "std::cos",  "std::tan",   "std::asin",  "std::acos",  "std::atan",
    "std::atan2", "std::sinh", "std::cosh",  "std::tanh",  "std::exp",   "std::exp2",
    "std::expm1", "std::log",  "std::log2",  "std::log10", "std::log1p", "std::pow",
    "std::hypot", "std::cbrt", "std::polar", "std::fma"};

/// What the files of one folder must not include, although their layer may.
struct FolderRule {
  string_view folder;
  std::vector<string_view> forbidden;  // beginnings of "quoted" includes
  string_view except;                  // the beginning of paths that may include them; empty: none
};

const std::vector<Layer>& layers() {
  // Core has no access to the environment, no output and no exit. It has only seeded randomness and a steady
  // clock. So it computes the same plan everywhere.
  static const std::vector<Layer> all = {
      {"core/",
       {"core/"},
       {"Eigen/", "malloc.h", "fleetplan/limits.h"},
       false,
       {"getenv", "cout", "cerr", "clog", "printf", "fprintf", "puts", "std::exit", "std::abort",
        "system_clock", "random_device", "rand", "srand", "spdlog", "nlohmann", "httplib"},
       true},
      // The public headers are all that users have.
      {"include/fleetplan/", {}, {"fleetplan/"}, false, {"getenv", "cout", "thread_local"}},
      // Only this folder of the library knows the service.
      {"library/service/",
       {"library/", "api/", "core/"},
       {"fleetplan/"},
       false,
       {"getenv", "cout", "cerr", "clog", "printf", "std::exit", "std::abort", "system_clock",
        "thread_local"},
       true},
      {"library/",
       {"library/", "core/"},
       {"fleetplan/"},
       false,
       {"getenv", "cout", "cerr", "clog", "printf", "std::exit", "std::abort", "system_clock",
        "thread_local"},
       true},
      {"examples/", {}, {"fleetplan/"}, false, {}},
      {"api/",
       {"api/", "core/"},
       {"fleetplan/", "nlohmann/", "png.h"},
       false,
       {"getenv", "cout", "cerr", "clog", "printf", "std::exit", "spdlog", "httplib"},
       true},
      {"server/", {"server/", "api/", "core/"}, {}, true, {"rand", "srand"}},
      {"tests/", {"tests/", "server/", "api/", "library/", "core/"}, {}, true, {}},
  };
  return all;
}

/// Folders whose files read what a request was compiled to, and not its robots; and the file that compiles
/// one of them alone.
constexpr std::array<string_view, 7> kWithoutRobots{"core/bounds/", "core/explain/", "core/fleet/",
                                                    "core/lns/",    "core/moves/",   "core/reservation/",
                                                    "core/sipp/"};
constexpr string_view kReadsRobots = "core/explain/narrow_places.cpp";

const std::vector<FolderRule>& folder_rules() {
  static const std::vector<string_view> all_robots = {"core/explain/", "core/fleet/", "core/lns/",
                                                      "core/moves/", "core/plan/"};
  static const std::vector<string_view> planning = {"core/bounds/", "core/explain/",    "core/fleet/",
                                                    "core/lns/",    "core/moves/",      "core/plan/",
                                                    "core/sipp/",   "core/reservation/"};
  static const std::vector<FolderRule> all = {
      // JSON knows nothing of the service; requests know nothing of answers, which may repeat parts of them.
      {"api/json/", {"api/request/", "api/response/", "api/endpoints/"}, {}},
      {"api/request/", {"api/response/", "api/endpoints/"}, {}},
      {"api/response/", {"api/endpoints/"}, {}},
      // Programs that only plan are linked without the service.
      {"library/", {"library/service/"}, "library/service/"},
      // The door is for callers of core; the rest of core does not include it.
      {"core/", {"core/plan/"}, "core/plan/"},
      // Folders for the planning of one robot do not depend on the planning of all robots.
      {"core/geometry/", all_robots, {}},
      {"core/map/", all_robots, {}},
      {"core/model/", all_robots, {}},
      {"core/runtime/", all_robots, {}},
      {"core/reservation/", all_robots, {}},
      {"core/bounds/", all_robots, {}},
      {"core/compile/", all_robots, {}},
      {"core/sipp/", all_robots, {}},
      // What follows from a plan, and its execution, whoever made it.
      {"core/advance/", planning, {}},
      {"core/execution/", planning, {}},
      // The checker is independent: it shares no collision test with the search, and reads the request
      // itself. If it shared a wrong reading, it would accept the result as right.
      {"core/verify/", planning, {}},
      {"core/verify/",
       {"core/advance/", "core/compile/", "core/execution/", "core/geometry/disk_motion.h",
        "core/geometry/motion_tree.h", "core/model/body.h", "core/model/itinerary.h", "core/model/loads.h",
        "core/model/served.h"},
       {}},
  };
  return all;
}

bool starts_with_any(string_view text, std::span<const string_view> beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](string_view beginning) { return text.starts_with(beginning); });
}

/// `<vector>` but not `<time.h>` or `<nlohmann/json.hpp>`.
bool standard_header(string_view name) { return name.find_first_of("./") == string_view::npos; }

bool identifier_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The text with comments, and the contents of string and character literals, blanked out. Include lines keep
/// their names. Raw strings end at the first )", because the project's raw strings have no delimiters.
std::string code_only(string_view text) {
  std::string code(text);
  const auto blank = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < std::min(to, code.size()); ++i) {
      if (code[i] != '\n') code[i] = ' ';
    }
  };
  const auto find_end = [&](string_view what, std::size_t from) {
    const std::size_t at = text.find(what, from);
    return at == string_view::npos ? text.size() : at + what.size();
  };
  for (std::size_t i = 0; i < text.size();) {
    const string_view rest = text.substr(i);
    std::size_t end = i + 1;
    if (rest.starts_with("#include")) {
      end = find_end("\n", i);
    } else if (rest.starts_with("//")) {
      end = find_end("\n", i);
      blank(i, end);
    } else if (rest.starts_with("/*")) {
      end = find_end("*/", i + 2);
      blank(i, end);
    } else if (rest.starts_with("R\"(")) {
      end = find_end(")\"", i + 3);
      blank(i + 3, end - 2);
    } else if (rest.front() == '"' ||
               (rest.front() == '\'' && (i == 0 || !identifier_character(text[i - 1])))) {
      while (end < text.size() && text[end] != rest.front()) end += text[end] == '\\' ? 2 : 1;
      blank(i + 1, end);
      end += 1;
    }
    i = end;
  }
  return code;
}

std::vector<string_view> lines_of(string_view text) {
  std::vector<string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    lines.push_back(text.substr(0, end + 1));
    text.remove_prefix(end + 1);
  }
  return lines;
}

/// The `"name"` or `<name>` of an include line, with its delimiters.
std::optional<string_view> included(string_view line) {
  const std::size_t hash = line.find_first_not_of(" \t");
  if (hash == string_view::npos || line[hash] != '#') return std::nullopt;
  const std::size_t word = line.find_first_not_of(" \t", hash + 1);
  if (word == string_view::npos || !line.substr(word).starts_with("include")) return std::nullopt;
  const std::size_t open = line.find_first_of("\"<", word);
  if (open == string_view::npos) return std::nullopt;
  const std::size_t close = line.find_first_of("\">", open + 1);
  if (close == string_view::npos) return std::nullopt;
  return line.substr(open, close - open + 1);
}

bool include_allowed(const Layer& layer, string_view include) {
  const string_view name = include.substr(1, include.size() - 2);
  if (name.find("..") != string_view::npos) return false;
  if (include.front() == '"') return starts_with_any(name, layer.own);
  return layer.any_third_party || standard_header(name) || starts_with_any(name, layer.third_party);
}

/// Whether a rule of the file's folder forbids an include that its layer allows.
bool forbidden_in_folder(string_view path, string_view include) {
  const string_view name = include.substr(1, include.size() - 2);
  return std::any_of(folder_rules().begin(), folder_rules().end(), [&](const FolderRule& rule) {
    const bool is_excepted = !rule.except.empty() && path.starts_with(rule.except);
    return path.starts_with(rule.folder) && !is_excepted && starts_with_any(name, rule.forbidden);
  });
}

bool uses(string_view code, string_view identifier) {
  for (std::size_t at = code.find(identifier); at != string_view::npos; at = code.find(identifier, at + 1)) {
    const std::size_t end = at + identifier.size();
    const bool whole = (at == 0 || !identifier_character(code[at - 1])) &&
                       (end == code.size() || !identifier_character(code[end]));
    if (whole) return true;
  }
  return false;
}

/// Whether the code has `Type(`, `Type{`, `Type name(` or `Type name{`. Parameters of a copy or of a
/// function, which begin with `const `, do not count.
bool constructs(string_view code, string_view type) {
  constexpr string_view kBlanks = " \t\r\n";
  const auto skip = [](string_view text, std::size_t to) { return text.substr(std::min(to, text.size())); };
  for (std::size_t at = code.find(type); at != string_view::npos; at = code.find(type, at + 1)) {
    if (at > 0 && identifier_character(code[at - 1])) continue;
    string_view rest = code.substr(at + type.size());
    const string_view name = skip(rest, rest.find_first_not_of(kBlanks));
    if (name.size() < rest.size()) {
      const auto end = std::find_if_not(name.begin(), name.end(), identifier_character);
      rest = skip(name, static_cast<std::size_t>(end - name.begin()));
      rest = skip(rest, rest.find_first_not_of(kBlanks));
    }
    const bool opens = rest.starts_with('(') || rest.starts_with('{');
    if (opens && !rest.substr(1).starts_with("const ")) return true;
  }
  return false;
}

/// Whether a source of core or api makes its own stop condition, which knows nothing of the request's bounds.
/// It must derive it from its Work or from another stop condition instead.
bool makes_a_stop_condition(string_view path, const std::string& code) {
  if (!path.starts_with("core/") && !path.starts_with("api/")) return false;
  // The examples are part of the program.
  if (path.starts_with("core/runtime/") || path == "api/endpoints/examples.cpp") return false;
  return code.find("StopCondition::never") != std::string::npos ||
         code.find("Work::unbounded") != std::string::npos || constructs(code, "StopCondition");
}

/// Whether a piece of code asks a stop condition.
bool asks_to_stop(string_view code) {
  return code.find(".met()") != string_view::npos || code.find("->met()") != string_view::npos;
}

/// The code between any of these characters, without the blanks around it; literals are blanked out.
std::vector<string_view> pieces_between(string_view code, string_view separators) {
  std::vector<string_view> pieces;
  while (!code.empty()) {
    const std::size_t end = std::min(code.find_first_of(separators), code.size());
    string_view piece = code.substr(0, end);
    piece.remove_prefix(std::min(piece.find_first_not_of(" \t\r\n"), piece.size()));
    piece = piece.substr(0, piece.find_last_not_of(" \t\r\n") + 1);
    if (!piece.empty()) pieces.push_back(piece);
    code.remove_prefix(std::min(end + 1, code.size()));
  }
  return pieces;
}

/// Whether this is `counter = 0`.
bool begins_to_count(string_view statement) {
  const auto end = std::find_if_not(statement.begin(), statement.end(), identifier_character);
  return end != statement.begin() && string_view(end, statement.end()) == " = 0";
}

/// Whether the number of steps between two questions, as such constants are called, is an operand.
bool computes_with_a_stride(string_view code) {
  for (const string_view end : {"BetweenPolls", "StopStride"}) {
    for (std::size_t at = code.find(end); at != string_view::npos; at = code.find(end, at + 1)) {
      std::size_t begin = at;
      while (begin > 0 && identifier_character(code[begin - 1])) --begin;
      if (begin == at || code[begin] != 'k') continue;
      const std::size_t before = code.find_last_not_of(" \t\r\n", begin - 1);
      if (before != string_view::npos && string_view("%<>=-").find(code[before]) != string_view::npos)
        return true;
    }
  }
  return false;
}

/// Whether a source counts the steps between two questions of a stop condition itself. It may do so by a
/// remainder in the statement that asks, by a counter that begins again beside it, or with a constant that
/// says how many.
bool counts_between_questions(string_view path, string_view code) {
  const bool is_of_these =
      path.starts_with("core/") || path.starts_with("api/") || path.starts_with("library/");
  if (!is_of_these || path.starts_with("core/runtime/")) return false;
  const std::vector<string_view> statements = pieces_between(code, ";{}");
  for (std::size_t k = 1; k < statements.size(); ++k) {
    if (asks_to_stop(statements[k - 1]) && begins_to_count(statements[k])) return true;
    if (asks_to_stop(statements[k]) && begins_to_count(statements[k - 1])) return true;
  }
  const std::vector<string_view> with_blocks = pieces_between(code, ";}");
  const bool by_remainder = std::any_of(with_blocks.begin(), with_blocks.end(), [](string_view statement) {
    return asks_to_stop(statement) && statement.find('%') != string_view::npos;
  });
  return by_remainder || computes_with_a_stride(code);
}

/// Whether a file that has to work with what was compiled reads robots as they were received.
bool reads_robots(string_view path, const std::string& code) {
  const auto is_of = [&](string_view folder) { return path.starts_with(folder); };
  return std::any_of(kWithoutRobots.begin(), kWithoutRobots.end(), is_of) && path != kReadsRobots &&
         uses(code, "Robot");
}

/// The folder below a layer that a file is in, such as "core/map"; the layer, if the file lies loose.
string_view folder_of(string_view path) {
  const std::size_t layer_end = std::min(path.find('/'), path.size());
  const std::size_t folder_end = path.find('/', layer_end + 1);
  return path.substr(0, folder_end == string_view::npos ? layer_end : folder_end);
}

/// The folders next to each other that two files are in, wherever these are: "core/verify/rules" and
/// "core/verify/pairs". None if one file is in a folder around the other one.
std::optional<std::pair<string_view, string_view>> siblings(string_view path, string_view other) {
  const auto folder_until = [](string_view file, std::size_t begin) {
    const std::size_t end = file.find('/', begin);
    return end == string_view::npos ? string_view() : file.substr(0, end);
  };
  for (std::size_t begin = 0;;) {
    const string_view mine = folder_until(path, begin);
    const string_view others = folder_until(other, begin);
    if (mine.empty() || others.empty()) return std::nullopt;
    if (mine != others) return std::pair(mine, others);
    begin = mine.size() + 1;
  }
}

/// Whether only blanks and comments come before it; comments are blanked out in `code`.
bool begins_with_pragma_once(string_view code) {
  const std::size_t first = code.find_first_not_of(" \t\r\n");
  return first != string_view::npos && code.substr(first).starts_with("#pragma once");
}

}  // namespace

std::vector<std::string> violations(string_view path, string_view text) {
  std::vector<std::string> found;
  const auto report = [&](string_view what, string_view which) {
    found.push_back(std::string(path) + " " + std::string(what) + std::string(which));
  };
  const auto layer = std::find_if(layers().begin(), layers().end(),
                                  [&](const Layer& each) { return path.starts_with(each.folder); });
  if (layer == layers().end()) {
    report("belongs to no layer", "");
    return found;
  }
  const std::string code = code_only(text);
  for (const string_view line : lines_of(code)) {
    const auto include = included(line);
    if (!include) continue;
    if (!include_allowed(*layer, *include) || forbidden_in_folder(path, *include))
      report("must not include ", *include);
  }
  std::vector<string_view> unwanted = layer->forbidden;
  if (layer->is_same_everywhere)
    unwanted.insert(unwanted.end(), kOtherEverywhere.begin(), kOtherEverywhere.end());
  for (const string_view identifier : unwanted) {
    if (uses(code, identifier)) report("must not use ", identifier);
  }
  if (makes_a_stop_condition(path, code)) {
    report("makes a stop condition of its own: derive it from the request's ", "Work");
  }
  if (counts_between_questions(path, code)) {
    report("counts the steps between two questions of a stop condition: use ", "StopStride");
  }
  if (reads_robots(path, code)) report("reads what was compiled, and not a ", "Robot");
  if (path.starts_with("core/") || path.starts_with("api/")) {
    for (std::string& loop : unbounded_loops(path, text, code)) found.push_back(std::move(loop));
  }
  if (path.ends_with(".h")) {
    if (!begins_with_pragma_once(code)) report("does not begin with ", "#pragma once");
    if (code.find("using namespace") != std::string::npos) report("must not use ", "using namespace");
  }
  return found;
}

std::vector<std::string> mutual_includes(const std::map<std::string, std::string>& sources) {
  static constexpr std::array<string_view, 3> kLayers{"core/", "api/", "server/"};
  std::set<std::pair<std::string, std::string>> includes;
  for (const auto& [path, text] : sources) {
    const std::string code = code_only(text);
    for (const string_view line : lines_of(code)) {
      const auto include = included(line);
      if (!include || !starts_with_any(include->substr(1), kLayers)) continue;
      const string_view name = include->substr(1, include->size() - 2);
      includes.emplace(folder_of(path), folder_of(name));
      if (const auto folders = siblings(path, name)) includes.emplace(folders->first, folders->second);
    }
  }
  std::vector<std::string> pairs;
  for (const auto& [from, to] : includes) {
    if (from < to && includes.contains({to, from})) pairs.push_back(from + " and " + to);
  }
  return pairs;
}

}  // namespace fleetplan::architecture
