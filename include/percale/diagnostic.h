#pragma once
/// \file
/// Messages to the user that say where, what was expected, what was found, and the remedy; and
/// `Result`, a value or the messages that explain why there is none.

#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace percale {

/// A place in a text. Lines and columns count from 1; columns count characters, not bytes.
struct Place {
  std::string file;
  int line = 0;    ///< 0: the message concerns the whole file.
  int column = 0;  ///< 0: the message concerns the whole line.
};

enum class Severity { Error, Warning, Note };

struct Diagnostic {
  Severity severity = Severity::Error;
  Place place;
  std::string message;  ///< One sentence, without the place: "/cloth/ks: expected a number >= 0 N/m, got \"5k\"".
  std::string excerpt;  ///< The line of text at `place`, shortened if long; empty when there is none.
  int caret = 0;        ///< Column in `excerpt` to mark, from 1; 0: no mark.
};

using Diagnostics = std::vector<Diagnostic>;

/// The message as a terminal shows it: "FILE:LINE:COLUMN: error: MESSAGE", then the excerpt and a
/// caret below it where there is one. Ends with a newline.
std::string Format(const Diagnostic& diagnostic);
/// All messages in order.
std::string Format(const Diagnostics& diagnostics);

bool HasErrors(const Diagnostics& diagnostics);

Diagnostic MakeError(std::string message);
Diagnostic MakeError(std::string file, std::string message);
Diagnostic MakeWarning(std::string message);
Diagnostic MakeWarning(std::string file, std::string message);
Diagnostic MakeNote(std::string message);
Diagnostic MakeNote(std::string file, std::string message);

/// A value, or the errors that explain why there is none. Warnings may stand beside a value.
template <class T>
class Result {
 public:
  Result(T value) : value_(std::move(value)) {}  // NOLINT: implicit, so that `return value;` reads well
  Result(T value, Diagnostics warnings) : value_(std::move(value)), diagnostics_(std::move(warnings)) {}
  Result(Diagnostics errors) : diagnostics_(std::move(errors)) { assert(HasErrors(diagnostics_)); }
  Result(Diagnostic error) : diagnostics_{std::move(error)} { assert(HasErrors(diagnostics_)); }

  explicit operator bool() const { return value_.has_value(); }
  bool ok() const { return value_.has_value(); }
  T& operator*() {
    assert(ok());
    return *value_;
  }
  const T& operator*() const {
    assert(ok());
    return *value_;
  }
  T* operator->() {
    assert(ok());
    return &*value_;
  }
  const T* operator->() const {
    assert(ok());
    return &*value_;
  }
  /// Errors when there is no value, else warnings (often none).
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  std::optional<T> value_;
  Diagnostics diagnostics_;
};

/// Success, or the errors of a function that returns nothing else.
using Status = Result<std::monostate>;
/// The `Status` of success.
inline Status Ok() {
  return std::monostate{};
}

}  // namespace percale
