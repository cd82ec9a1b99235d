#include "apps/viewer/widgets.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "apps/viewer/actions.h"
#include "apps/viewer/window.h"
#include "core/text.h"
#include "percale/parameters.h"

namespace percale::viewer {
namespace {

// Columns of a row [screen unit at scale 1].
constexpr float kSliderAt = 118, kSliderWidth = 100, kBoxWidth = 68, kGap = 5;
constexpr float kTooltipWidth = 340;
constexpr double kTooltipDelay = 0.35;  // [s]
constexpr int kSliderDigits = 3;        // Significant ones that a slider sets.

/// How a number is shown where that is not as the file states it.
struct Shown {
  std::string_view group, name, unit;
  double divisor;
};
constexpr Shown kShown[] = {{"cloth", "density", "g/cm^2", 10}};

const Shown* ShownOf(const Parameter& parameter) {
  for (const Shown& shown : kShown) {
    if (shown.group == parameter.group && shown.name == parameter.name) return &shown;
  }
  return nullptr;
}

double RoundToDigits(double value, int digits) {
  if (value == 0 || !std::isfinite(value)) return value;
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  // Read back with the C library that wrote it, so that its locale does not matter.
  double rounded = value;
  std::sscanf(text, "%lf", &rounded);
  return rounded;
}

/// The label of a row; what does not fit its column is cut off.
void RowText(const UiState& state, std::string_view label) {
  ImGui::AlignTextToFramePadding();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushClipRect({at.x, at.y}, {at.x + (kSliderAt - kGap / 2) * state.scale, at.y + 3 * ImGui::GetFrameHeight()},
                      true);
  ImGui::TextUnformatted(label.data(), label.data() + label.size());
  ImGui::PopClipRect();
}

/// Shown when the pointer has rested on the last item for a moment, so that it does not hide what
/// the user is about to do.
void Tooltip(Session& session, UiState& state, std::string_view control, const std::string& text) {
  if (state.palette.open || !ImGui::IsItemHovered() || ImGui::IsItemActive()) return;
  const ImVec2 at = ImGui::GetItemRectMin();
  if (at.x != state.hoveredAt[0] || at.y != state.hoveredAt[1]) {
    state.hoveredAt[0] = at.x;
    state.hoveredAt[1] = at.y;
    state.hoveredSince = ImGui::GetTime();
  }
  if (ImGui::GetTime() - state.hoveredSince < kTooltipDelay) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(kTooltipWidth * state.scale);
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopTextWrapPos();
  NoteWindow(session, state, "tooltip");
  ImGui::EndTooltip();
  if (!session.logged() || state.tooltipLogged == control) return;
  state.tooltipLogged = control;
  session.log().Write(LogLine("tooltip").Text("control", control).Text("text", text));
}

/// What a numeric control is about.
struct NumberSpec {
  std::string id;  ///< For the log and for ImGui: "cloth.ks".
  std::string label;
  std::string unit;
  std::string help;         ///< Tooltip.
  double min = 0, max = 1;  ///< Of the slider; equal: no slider.
  bool logarithmic = false;
  bool whole = false;
};

struct NumberEdit {
  std::optional<double> value;      ///< Set: the user wants this.
  std::optional<std::string> text;  ///< Set: the user has typed this, which is no number.
};

/// Label, slider, box, unit. `value` is shown, and changed by nobody but the caller.
NumberEdit NumberRow(Session& session, UiState& state, const NumberSpec& spec, double value) {
  NumberEdit edit;
  const float scale = state.scale;
  ImGui::PushID(spec.id.c_str());
  const float left = ImGui::GetCursorPosX();
  RowText(state, spec.label);
  Tooltip(session, state, spec.id, spec.help);

  if (spec.max > spec.min) {
    ImGui::SameLine(left + kSliderAt * scale);
    ImGui::SetNextItemWidth(kSliderWidth * scale);
    double slid = value;
    ImGuiSliderFlags flags = ImGuiSliderFlags_NoInput;
    if (spec.logarithmic) flags |= ImGuiSliderFlags_Logarithmic;
    if (ImGui::SliderScalar("##slider", ImGuiDataType_Double, &slid, &spec.min, &spec.max, "", flags)) {
      slid = spec.whole ? std::round(slid) : RoundToDigits(slid, kSliderDigits);
      // Near 0 digits do not end: a linear slider has a thousandth of its range as its step.
      if (!spec.logarithmic && std::abs(slid) < 1e-3 * (spec.max - spec.min)) slid = 0;
      if (slid != value) edit.value = slid;
    }
    Control(session, state, spec.id, spec.help);
  }

  ImGui::SameLine(left + (kSliderAt + kSliderWidth + kGap) * scale);
  ImGui::SetNextItemWidth(kBoxWidth * scale);
  const ImGuiID id = ImGui::GetID("##box");
  const std::string shown = FormatNumber(RoundToDigits(value, 6));
  char text[64];
  std::snprintf(text, sizeof text, "%s", state.editedBox == id ? state.editedText.c_str() : shown.c_str());
  ImGui::InputText("##box", text, sizeof text, ImGuiInputTextFlags_AutoSelectAll | ImGuiInputTextFlags_CharsNoBlank);
  if (ImGui::IsItemActive()) {
    state.editedBox = id;
    state.editedText = text;
  } else if (state.editedBox == id || ImGui::IsItemDeactivated()) {
    state.editedBox = 0;
    if (text != shown) {
      const std::optional<double> number = ParseTypedNumber(text);
      if (number)
        edit.value = *number;
      else
        edit.text = text;
    }
  }
  Control(session, state, spec.id + " box", spec.help);
  if (!spec.unit.empty()) {
    ImGui::SameLine(0, kGap * scale);
    ImGui::TextDisabled("%s", spec.unit.c_str());
  }
  ImGui::PopID();
  return edit;
}

/// Label of a row whose control is not a number; leaves the cursor at the control.
void RowLabel(Session& session, UiState& state, std::string_view label, const std::string& help) {
  const float left = ImGui::GetCursorPosX();
  RowText(state, label);
  Tooltip(session, state, label, help);
  ImGui::SameLine(left + kSliderAt * state.scale);
  ImGui::SetNextItemWidth((kSliderWidth + kGap + kBoxWidth) * state.scale);
}

/// A row with a list to choose from: the chosen one of `names`, or nothing when the user has not chosen.
std::optional<int> DropDown(Session& session, UiState& state, const std::string& id, std::string_view label,
                            const std::string& help, int current, const std::vector<std::string>& names,
                            const std::string& preview) {
  RowLabel(session, state, label, help);
  std::optional<int> chosen;
  if (!BeginList(session, state, id, help, preview)) return chosen;
  for (int i = 0; i < static_cast<int>(names.size()); ++i) {
    const std::string& name = names[static_cast<std::size_t>(i)];
    if (ImGui::Selectable(name.c_str(), i == current)) chosen = i;
    NoteBox(session, state, id + "/" + name);
    if (i == current) ImGui::SetItemDefaultFocus();
  }
  ImGui::EndCombo();
  return chosen;
}

/// A parameter with the objects that its control shows and sets.
struct Target {
  const Parameter& parameter;
  int index;           ///< Of the object, or kAll.
  std::size_t first;   ///< The object whose value is shown.
  bool mixed = false;  ///< Others of kAll have other values.
  std::string id;      ///< "cloth.ks"
};

Target MakeTarget(const Session& session, std::string_view group, std::string_view name, int index) {
  const Parameter& parameter = *FindParameter(group, name);
  Target target{parameter, index, 0, false, std::string(group) + "." + std::string(name)};
  if (!FindGroup(group)->isArray) return target;
  const std::size_t count = FindGroup(group)->count(session.scene());
  if (index != Session::kAll) {
    target.first = static_cast<std::size_t>(index);
    target.id = std::string(group) + "." + std::to_string(index) + "." + std::string(name);
    return target;
  }
  for (std::size_t i = 1; i < count; ++i) {
    target.mixed |= parameter.get(session.scene(), i) != parameter.get(session.scene(), 0);
  }
  return target;
}

std::string HelpText(const Target& target) {
  const Parameter& p = target.parameter;
  std::string text(p.help);
  if (target.mixed) text += "\nThe cloths differ here; the first one's value is shown.";
  const std::string path = std::string(p.group) + "." + std::string(p.name);
  text += "\n\n" + path + ": " + DescribeExpected(p);
  if (p.typicalMax > p.typicalMin) {
    text += "; typically " + FormatNumber(p.typicalMin) + " to " + FormatNumber(p.typicalMax);
  }
  text += "; by default " + FormatValue(DefaultValue(p)) + ".";
  if (const Shown* shown = ShownOf(p)) {
    text += "\nShown in " + std::string(shown->unit) + ", which is " + FormatNumber(shown->divisor) + " " +
            std::string(p.unit) + ".";
  }
  return Readable(text);
}

std::string LabelText(const Target& target) {
  return std::string(target.parameter.label) + (target.mixed ? " *" : "");
}

NumberSpec MakeSpec(const Target& target, double divisor) {
  const Parameter& p = target.parameter;
  const Shown* shown = ShownOf(p);
  return {target.id,        LabelText(target),           Readable(shown ? shown->unit : p.unit),
          HelpText(target), p.typicalMin / divisor,      p.typicalMax / divisor,
          p.logarithmic,    p.kind == ValueKind::Integer};
}

/// The parameter as it would be described if scenes stated it the way it is shown.
Parameter AsShown(const Parameter& parameter) {
  Parameter asShown = parameter;
  if (const Shown* shown = ShownOf(parameter)) {
    asShown.unit = shown->unit;
    asShown.min /= shown->divisor;
    asShown.max /= shown->divisor;
  }
  return asShown;
}

std::string NotExpected(const std::string& expected, const std::string& typed) {
  return "expected " + expected + ", got " + Quote(typed, 40);
}

void Number(Session& session, UiState& state, const Target& target) {
  const Shown* shown = ShownOf(target.parameter);
  const double divisor = shown ? shown->divisor : 1;
  const NumberSpec spec = MakeSpec(target, divisor);
  const double value = std::get<double>(target.parameter.get(session.scene(), target.first));
  const NumberEdit edit = NumberRow(session, state, spec, value / divisor);
  const Parameter asShown = AsShown(target.parameter);
  if (edit.text) {
    session.Refuse(target.parameter, target.index, NotExpected(DescribeExpected(asShown), *edit.text));
  } else if (edit.value) {
    if (const auto problem = CheckValue(asShown, *edit.value))
      session.Refuse(target.parameter, target.index, *problem);
    else
      session.SetParameter(target.parameter, target.index, *edit.value * divisor);
  }
}

void Vector(Session& session, UiState& state, const Target& target) {
  const char* const kAxes[] = {"x", "y", "z"};
  Vec3 value = std::get<Vec3>(target.parameter.get(session.scene(), target.first));
  double* const components[] = {&value.x, &value.y, &value.z};
  const NumberSpec common = MakeSpec(target, 1);
  for (int axis = 0; axis < 3; ++axis) {
    NumberSpec spec = common;
    spec.id += std::string(".") + kAxes[axis];
    spec.label += std::string(" ") + kAxes[axis];
    const NumberEdit edit = NumberRow(session, state, spec, *components[axis]);
    if (edit.value) {
      *components[axis] = *edit.value;
      session.SetParameter(target.parameter, target.index, value);
    }
    if (edit.text) session.Refuse(target.parameter, target.index, NotExpected("a number", *edit.text));
  }
}

void ColorPicker(Session& session, UiState& state, const Target& target) {
  const Vec3 value = std::get<Vec3>(target.parameter.get(session.scene(), target.first));
  const std::string help = HelpText(target);
  RowLabel(session, state, LabelText(target), help);
  float rgb[3] = {static_cast<float>(value.x), static_cast<float>(value.y), static_cast<float>(value.z)};
  if (ImGui::ColorEdit3(("##" + target.id).c_str(), rgb)) {
    Vec3 changed;
    double* const to[] = {&changed.x, &changed.y, &changed.z};
    for (int i = 0; i < 3; ++i) *to[i] = RoundToDigits(std::clamp(static_cast<double>(rgb[i]), 0.0, 1.0), 4);
    session.SetParameter(target.parameter, target.index, changed);
  }
  Control(session, state, target.id, help);
}

void Choice(Session& session, UiState& state, const Target& target) {
  const Parameter& p = target.parameter;
  const Value value = p.get(session.scene(), target.first);
  const std::vector<std::string> names(p.choices.begin(), p.choices.end());
  int current = 0;
  if (const std::string* text = std::get_if<std::string>(&value))
    current = static_cast<int>(std::find(names.begin(), names.end(), *text) - names.begin());
  else
    current = static_cast<int>(std::get<double>(value));
  const std::string preview = current < static_cast<int>(names.size()) ? names[static_cast<std::size_t>(current)] : "";
  const std::optional<int> chosen =
      DropDown(session, state, target.id, LabelText(target), HelpText(target), current, names, preview);
  if (!chosen) return;
  if (p.kind == ValueKind::Choice)
    session.SetParameter(p, target.index, names[static_cast<std::size_t>(*chosen)]);
  else
    session.SetParameter(p, target.index, static_cast<double>(*chosen));
}

void Tick(Session& session, UiState& state, const Target& target, const std::string& label) {
  bool on = std::get<bool>(target.parameter.get(session.scene(), target.first));
  if (ImGui::Checkbox((label + "##" + target.id).c_str(), &on)) {
    session.SetParameter(target.parameter, target.index, on);
  }
  Control(session, state, target.id, HelpText(target));
}

/// What is to be shown of a parameter comes with the next control.
void MarkJump(UiState& state, std::string_view group, std::string_view name) {
  state.jumpHere = !state.jump.empty() && state.jump == std::string(group) + "." + std::string(name);
  state.jumpFound |= state.jumpHere;
}

}  // namespace

std::string Readable(std::string_view unit) {
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit.substr(i, 2) == "^2" || unit.substr(i, 2) == "^3") {
      text += unit[i + 1] == '2' ? "\u00b2" : "\u00b3";
      ++i;
    } else {
      text += unit[i];
    }
  }
  return text;
}

void Control(Session& session, UiState& state, std::string_view name, const std::string& help) {
  NoteBox(session, state, name);
  if (std::exchange(state.jumpHere, false) && !state.jumpSearching) GiveKeyboard(state);
  Tooltip(session, state, name, help);
}

bool BeginList(Session& session, UiState& state, const std::string& name, const std::string& help,
               const std::string& preview) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), size(ImGui::CalcItemWidth(), ImGui::GetFrameHeight());
  const bool visible = ImGui::IsRectVisible(size);
  if (ImGui::BeginCombo(("##" + name).c_str(), preview.c_str(), ImGuiComboFlags_HeightLarge)) {
    // The last item is one of the list now.
    if (session.logged() && visible) state.boxes[name] = {at.x, at.y, size.x, size.y};
    return true;
  }
  Control(session, state, name, help);
  return false;
}

void GiveKeyboard(UiState& state) {
  Window::FocusLastItem();
  ImGui::SetScrollHereY(0.3f);
  state.keyboardIn = KeyboardIn::Panels;
  state.jump.clear();
}

bool ActionButton(Session& session, UiState& state, std::string_view name) {
  const Action& action = FindAction(name);
  const bool can = !action.enabled || action.enabled(session, state);
  ImGui::BeginDisabled(!can);
  const bool pressed = ImGui::Button(std::string(action.title).c_str());
  ImGui::EndDisabled();
  const std::string keys = KeysText(action);
  Control(session, state, "button " + std::string(name),
          std::string(action.help) + (keys.empty() ? "" : "\n\nKey: " + keys));
  if (pressed) RunAction(action, session, state);
  return pressed;
}

void NoteBox(const Session& session, UiState& state, std::string_view name) {
  if (!session.logged() || !ImGui::IsItemVisible()) return;
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  state.boxes[std::string(name)] = {min.x, min.y, max.x - min.x, max.y - min.y};
  if (state.keyboardIn != KeyboardIn::Picture && ImGui::IsItemFocused()) state.focusedControl = name;
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem)) state.hoveredControl = name;
  if (ImGui::IsItemActive()) state.activeControl = name;
}

void NoteWindow(const Session& session, UiState& state, std::string_view name) {
  if (!session.logged()) return;
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  state.boxes[std::string(name)] = {at.x, at.y, size.x, size.y};
}

void ParameterRow(Session& session, UiState& state, std::string_view group, std::string_view name, int index) {
  if (!IsHeeded(*FindParameter(group, name), session.scene())) return;
  const Target target = MakeTarget(session, group, name, index);
  MarkJump(state, group, name);
  switch (target.parameter.kind) {
    case ValueKind::Number:
      return Number(session, state, target);
    case ValueKind::Integer:
      if (!target.parameter.choices.empty()) return Choice(session, state, target);
      return Number(session, state, target);
    case ValueKind::Boolean:
      RowLabel(session, state, LabelText(target), HelpText(target));
      return Tick(session, state, target, "");
    case ValueKind::Choice:
      return Choice(session, state, target);
    case ValueKind::Vector:
      if (name == "color" || name == "back_color") return ColorPicker(session, state, target);
      return Vector(session, state, target);
    case ValueKind::Text:
    case ValueKind::GridPoints:
      break;
  }
  RowLabel(session, state, LabelText(target), HelpText(target));
  Wrapped(FormatValue(target.parameter.get(session.scene(), target.first)));
}

void ParameterTick(Session& session, UiState& state, std::string_view group, std::string_view name, int index) {
  const Target target = MakeTarget(session, group, name, index);
  MarkJump(state, group, name);
  Tick(session, state, target, LabelText(target));
}

void ShaderRow(Session& session, UiState& state) {
  const Target target = MakeTarget(session, "look", "shader", Session::kAll);
  const std::vector<std::string>& names = session.liveView().shaderNames();
  const std::string current = session.view().look.shader;
  const int at = static_cast<int>(std::find(names.begin(), names.end(), current) - names.begin());
  const std::string help = HelpText(target) + "\n\nKeys: " + KeysText(FindAction("previous_shader")) + " " +
                           KeysText(FindAction("next_shader"));
  if (const auto chosen = DropDown(session, state, target.id, LabelText(target), help, at, names, current))
    session.SetShader(names[static_cast<std::size_t>(*chosen)]);
}

void UniformRow(Session& session, UiState& state, const ShaderParameter& parameter) {
  UniformValue value = session.liveView().Uniform(parameter);
  const std::string id = "uniform." + parameter.name;
  std::string help = (parameter.help.empty() ? "" : parameter.help + "\n\n") + parameter.name + " of the shader " +
                     session.view().look.shader;
  if (parameter.type != ShaderParameter::Type::Bool && parameter.max > parameter.min && parameter.choices.empty()) {
    help += ": " + FormatNumber(static_cast<double>(parameter.min)) + " to " +
            FormatNumber(static_cast<double>(parameter.max));
  }
  const auto number = [&](const std::string& suffix, const std::string& label, float& component) {
    const NumberSpec spec{id + suffix,
                          label,
                          "",
                          help,
                          static_cast<double>(parameter.min),
                          static_cast<double>(parameter.max),
                          false,
                          parameter.type == ShaderParameter::Type::Int};
    const NumberEdit edit = NumberRow(session, state, spec, static_cast<double>(component));
    if (edit.text) session.liveView().RefuseUniform(parameter, NotExpected("a number", *edit.text));
    if (!edit.value) return;
    component = static_cast<float>(std::clamp(*edit.value, spec.min, spec.max));
    if (spec.whole) component = std::round(component);
    session.liveView().SetUniform(parameter, value);
  };
  switch (parameter.type) {
    case ShaderParameter::Type::Bool: {
      RowLabel(session, state, parameter.label, help);
      bool on = value[0] != 0;
      if (ImGui::Checkbox(("##" + id).c_str(), &on)) {
        value[0] = on ? 1.0f : 0.0f;
        session.liveView().SetUniform(parameter, value);
      }
      Control(session, state, id, help);
      break;
    }
    case ShaderParameter::Type::Int:
      if (parameter.choices.empty()) {
        number("", parameter.label, value[0]);
      } else {
        const int last = static_cast<int>(parameter.choices.size()) - 1;
        const int current = std::clamp(static_cast<int>(value[0]), 0, last);
        const auto chosen = DropDown(session, state, id, parameter.label, help, current, parameter.choices,
                                     parameter.choices[static_cast<std::size_t>(current)]);
        if (!chosen) break;
        value[0] = static_cast<float>(*chosen);
        session.liveView().SetUniform(parameter, value);
      }
      break;
    case ShaderParameter::Type::Float:
      number("", parameter.label, value[0]);
      break;
    case ShaderParameter::Type::Vector:
      if (parameter.color) {
        RowLabel(session, state, parameter.label, help);
        if (ImGui::ColorEdit3(("##" + id).c_str(), value.data())) {
          for (float& component : value) component = std::clamp(component, 0.0f, 1.0f);
          session.liveView().SetUniform(parameter, value);
        }
        Control(session, state, id, help);
      } else {
        number(".x", parameter.label + " x", value[0]);
        number(".y", parameter.label + " y", value[1]);
        number(".z", parameter.label + " z", value[2]);
      }
      break;
  }
}

void FactRow(const UiState& state, const char* label, const std::string& value) {
  const float left = ImGui::GetCursorPosX();
  ImGui::TextDisabled("%s", label);
  ImGui::SameLine(left + kSliderAt * state.scale);
  ImGui::TextUnformatted(value.data(), value.data() + value.size());
}

void Wrapped(std::string_view text) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopTextWrapPos();
}

}  // namespace percale::viewer
