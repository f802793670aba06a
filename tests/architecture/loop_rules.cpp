#include "tests/architecture/loop_rules.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>

namespace fleetplan::architecture {
namespace {

using std::string_view;

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The words of a piece of code, such as what comes before a brace.
bool has_word(string_view code, string_view word) {
  for (std::size_t at = code.find(word); at != string_view::npos; at = code.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_word(code[at - 1])) && (end == code.size() || !is_word(code[end]))) return true;
  }
  return false;
}

/// Whether a function asks, or hands on, what bounds a request.
bool mentions_a_stop(string_view function) {
  return function.find("stop") != string_view::npos || function.find("Stop") != string_view::npos ||
         function.find("stride_.met") != string_view::npos || has_word(function, "work") ||
         has_word(function, "work_") || function.find("Work&") != string_view::npos;
}

/// Walks through the code of a file: scopes by their braces, loops with and without.
class LoopFinder {
 public:
  LoopFinder(string_view path, string_view text, string_view code) : path_(path), text_(text), code_(code) {}

  std::vector<std::string> run() {
    for (at_ = 0; at_ < code_.size(); ++at_) {
      if (is_word(code_[at_])) {
        word();
      } else {
        sign(code_[at_]);
      }
    }
    return std::move(found_);
  }

 private:
  enum class Kind { outside, function, loop, block };
  struct Scope {
    Kind kind;
    std::size_t begin;    // of the statement that opens it
    int open_loops = 0;   // without braces, which end with the next statement of the scope
    bool nested = false;  // a loop of the function is inside another loop
  };

  void word() {
    std::size_t end = at_;
    while (end < code_.size() && is_word(code_[end])) ++end;
    const string_view word = code_.substr(at_, end - at_);
    at_ = end - 1;
    if (parentheses_ > 0 || !in_function()) return;
    if (word != "for" && word != "while" && word != "do") return;
    if (loop_depth() > 0) function()->nested = true;
    loop_is_next_ = true;
    if (word != "do") skip_parentheses();
    const std::size_t next = code_.find_first_not_of(" \t\r\n", at_ + 1);
    if (next == string_view::npos || code_[next] == '{') return;
    loop_is_next_ = false;
    ++scopes_.back().open_loops;
  }

  void sign(char c) {
    if (c == '(') ++parentheses_;
    if (c == ')') --parentheses_;
    if (c == '{') open();
    if (c == '}') close();
    if (c == ';' && parentheses_ == 0) end_statement();
  }

  void open() {
    scopes_.push_back({kind_of_next(), statement_});
    brackets_.push_back(parentheses_);
    parentheses_ = 0;
    loop_is_next_ = false;
    statement_ = at_ + 1;
  }

  void close() {
    if (scopes_.empty()) return;
    const Scope scope = scopes_.back();
    scopes_.pop_back();
    parentheses_ = brackets_.back();
    brackets_.pop_back();
    if (scope.kind == Kind::function && scope.nested) judge(scope);
    if (parentheses_ == 0) end_statement();
  }

  void end_statement() {
    statement_ = at_ + 1;
    if (!scopes_.empty()) scopes_.back().open_loops = 0;
  }

  Kind kind_of_next() const {
    if (loop_is_next_) return Kind::loop;
    if (in_function()) return Kind::block;
    const string_view before = code_.substr(statement_, at_ - statement_);
    for (const string_view container : {"namespace", "class", "struct", "enum", "union"}) {
      if (has_word(before, container) && before.find('(') == string_view::npos) return Kind::outside;
    }
    return before.find('(') == string_view::npos ? Kind::outside : Kind::function;
  }

  bool in_function() const {
    return std::any_of(scopes_.begin(), scopes_.end(),
                       [](const Scope& scope) { return scope.kind == Kind::function; });
  }
  Scope* function() {
    const auto found = std::find_if(scopes_.begin(), scopes_.end(),
                                    [](const Scope& scope) { return scope.kind == Kind::function; });
    return &*found;
  }
  int loop_depth() const {
    int depth = 0;
    for (const Scope& scope : scopes_) depth += (scope.kind == Kind::loop ? 1 : 0) + scope.open_loops;
    return depth;
  }

  void skip_parentheses() {
    at_ = std::min(code_.find('(', at_), code_.size());
    int open = 0;
    for (; at_ < code_.size(); ++at_) {
      if (code_[at_] == '(') ++open;
      if (code_[at_] == ')' && --open == 0) return;
    }
  }

  void judge(const Scope& scope) {
    const string_view function = code_.substr(scope.begin, at_ - scope.begin);
    if (mentions_a_stop(function)) return;
    if (text_.substr(scope.begin, at_ - scope.begin).find("// Bounded: ") != string_view::npos) return;
    const std::size_t begin = std::min(code_.find_first_not_of(" \t\r\n", scope.begin), code_.size());
    const auto line = 1 + std::count(code_.begin(), code_.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
    found_.push_back(std::string(path_) + ":" + std::to_string(line) +
                     " has a loop in a loop: ask a stop condition, or say `// Bounded: ` by what");
  }

  const string_view path_;
  const string_view text_;
  const string_view code_;
  std::size_t at_ = 0;
  std::size_t statement_ = 0;  // where the current one begins
  int parentheses_ = 0;
  bool loop_is_next_ = false;  // the next brace opens the body of a loop
  std::vector<int> brackets_;  // the parentheses around each scope
  std::vector<Scope> scopes_;
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> unbounded_loops(string_view path, string_view text, string_view code) {
  return LoopFinder(path, text, code).run();
}

}  // namespace fleetplan::architecture
