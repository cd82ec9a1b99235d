#include <algorithm>
#include <cctype>
#include <optional>
#include <sstream>

#include "core/text.h"
#include "render/shader_library.h"

namespace percale {
namespace {

bool IsNameCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

std::string Trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return std::string(text);
}

bool ReadNumber(const std::string& word, float& number) {
  const std::optional<double> value = ParseTypedNumber(word);
  if (value) number = static_cast<float>(*value);
  return value.has_value();
}

std::vector<std::string> Words(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

// The numbers of an initialiser such as "0.5", "1.f", "true", "vec3(1, 0, 0)" or "vec3(1)"; none if
// it is anything else.
std::vector<float> InitialiserNumbers(std::string text, const std::string& type, std::size_t components) {
  text = Trimmed(text);
  if (const std::size_t open = text.find('('); open != std::string::npos) {
    if (Trimmed(text.substr(0, open)) != type || text.back() != ')') return {};
    text = text.substr(open + 1, text.size() - open - 2);
  }
  std::replace(text.begin(), text.end(), ',', ' ');
  std::vector<float> numbers;
  for (std::string& word : Words(text)) {
    float number = 0;
    if (word.back() == 'f' || word.back() == 'F') word.pop_back();
    if (word == "true" || word == "false") {
      number = word == "true" ? 1.0f : 0.0f;
    } else if (!ReadNumber(word, number)) {
      return {};
    }
    numbers.push_back(number);
  }
  if (numbers.size() == 1) numbers.resize(components, numbers[0]);
  return numbers;
}

struct Declaration {
  std::string type, name, initialiser, comment;
};

// "uniform TYPE NAME [= INITIALISER]; // COMMENT" on one line, with at least one @word in the comment.
bool ParseDeclaration(const std::string& line, Declaration& declaration) {
  const std::size_t comment = line.find("//");
  if (comment == std::string::npos || line.find('@', comment) == std::string::npos) return false;
  const std::string code = Trimmed(std::string_view(line).substr(0, comment));
  const std::size_t end = code.find(';');
  if (code.rfind("uniform", 0) != 0 || end == std::string::npos || code.size() <= 7 || IsNameCharacter(code[7]))
    return false;
  std::string head = code.substr(7, end - 7);
  if (const std::size_t equals = head.find('='); equals != std::string::npos) {
    declaration.initialiser = head.substr(equals + 1);
    head.resize(equals);
  }
  std::vector<std::string> words = Words(head);
  // A precision may stand before the type in shaders for the web.
  if (words.size() == 3 && (words[0] == "highp" || words[0] == "mediump" || words[0] == "lowp"))
    words.erase(words.begin());
  if (words.size() != 2) return false;
  declaration.type = words[0];
  declaration.name = words[1];
  declaration.comment = line.substr(comment + 2);
  return true;
}

}  // namespace

std::vector<ShaderParameter> ParseShaderParameters(std::string_view text, const std::string& file,
                                                   Diagnostics& diagnostics) {
  std::vector<ShaderParameter> parameters;
  std::istringstream in{std::string(text)};
  int lineNumber = 0;
  for (std::string line; std::getline(in, line);) {
    ++lineNumber;
    Declaration declaration;
    if (!ParseDeclaration(line, declaration)) continue;
    const auto warn = [&](const std::string& message) {
      Diagnostic warning = MakeWarning(declaration.name + ": " + message);
      warning.place = {file, lineNumber, 0};
      warning.excerpt = Trimmed(line);
      diagnostics.push_back(std::move(warning));
    };

    ShaderParameter parameter;
    parameter.name = declaration.name;
    parameter.label = declaration.name.rfind("u_", 0) == 0 ? declaration.name.substr(2) : declaration.name;
    if (declaration.type == "float") {
      parameter.type = ShaderParameter::Type::Float;
    } else if (declaration.type == "int") {
      parameter.type = ShaderParameter::Type::Int;
    } else if (declaration.type == "bool") {
      parameter.type = ShaderParameter::Type::Bool;
    } else if (declaration.type == "vec3") {
      parameter.type = ShaderParameter::Type::Vector;
    } else {
      warn("expected a float, int, bool or vec3 as a parameter, found " + declaration.type);
      continue;
    }
    const std::size_t components = parameter.type == ShaderParameter::Type::Vector ? 3 : 1;

    std::vector<float> defaults = InitialiserNumbers(declaration.initialiser, declaration.type, components);
    const std::string& comment = declaration.comment;
    for (std::size_t at = comment.find('@'); at != std::string::npos;) {
      const std::size_t next = comment.find('@', at + 1);
      const std::string entry = Trimmed(std::string_view(comment).substr(at + 1, next - at - 1));
      at = next;
      const std::size_t space = std::min(entry.find_first_of(" \t"), entry.size());
      const std::string key = entry.substr(0, space), rest = Trimmed(std::string_view(entry).substr(space));
      std::vector<float> numbers;
      bool allNumbers = true;
      for (const std::string& word : Words(rest)) {
        float number = 0;
        if (word == "true" || word == "false") {
          number = word == "true" ? 1.0f : 0.0f;
        } else {
          allNumbers &= ReadNumber(word, number);
        }
        numbers.push_back(number);
      }
      if (key == "range") {
        if (allNumbers && numbers.size() == 2 && numbers[0] < numbers[1]) {
          parameter.min = numbers[0];
          parameter.max = numbers[1];
        } else {
          warn("expected two growing numbers after @range, found \"" + rest + "\"");
        }
      } else if (key == "default") {
        if (allNumbers && numbers.size() == components) {
          defaults = numbers;
        } else {
          warn("expected " + std::to_string(components) + (components == 1 ? " number" : " numbers") +
               " after @default, found \"" + rest + "\"");
        }
      } else if (key == "label") {
        parameter.label = rest;
      } else if (key == "help") {
        parameter.help = rest;
      } else if (key == "color") {
        if (components == 3) {
          parameter.color = true;
        } else {
          warn("@color is for a vec3, this is a " + declaration.type);
        }
      } else if (key == "choices") {
        std::istringstream choices(rest);
        for (std::string choice; std::getline(choices, choice, '|');) parameter.choices.push_back(Trimmed(choice));
        if (parameter.type != ShaderParameter::Type::Int || parameter.choices.size() < 2) {
          warn("@choices is for an int and names at least two values: @choices first|second");
          parameter.choices.clear();
        } else {
          parameter.min = 0;
          parameter.max = static_cast<float>(parameter.choices.size() - 1);
        }
      } else {
        warn("@" + key + " is unknown; expected @range, @default, @label, @help, @color or @choices");
      }
    }
    if (defaults.size() != components) {
      if (!Trimmed(declaration.initialiser).empty()) {
        warn("the initial value \"" + Trimmed(declaration.initialiser) + "\" is not read here; state it as @default");
      }
      defaults.assign(components, parameter.min);
    }
    for (std::size_t i = 0; i < components; ++i) {
      parameter.defaultValue[i] = std::clamp(defaults[i], parameter.min, parameter.max);
    }
    if (parameter.defaultValue !=
        UniformValue{defaults[0], components > 1 ? defaults[1] : 0, components > 2 ? defaults[2] : 0}) {
      warn("the default lies outside of the range and is moved to its end");
    }
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

}  // namespace percale
