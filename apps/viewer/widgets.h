#pragma once
/// \file
/// The controls that panels are made of. Labels, units, ranges and help come from the parameter
/// table and from the annotations of shaders; a panel only names what it shows.

#include <string>
#include <string_view>

#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"

namespace percale::viewer {

/// A control for one parameter of the objects that are selected: kAll, or object `index` of its
/// group. The parameter must exist. Numbers get a slider over their typical range and a box to type
/// in, vectors one of each per component, choices a drop-down, colours a colour picker.
void ParameterRow(Session& session, UiState& state, std::string_view group, std::string_view name,
                  int index = Session::kAll);

/// A tick box with its label alone, to stand beside others.
void ParameterTick(Session& session, UiState& state, std::string_view group, std::string_view name,
                   int index = Session::kAll);

/// The drop-down of the shaders there are.
void ShaderRow(Session& session, UiState& state);

/// A control for a parameter of the current shader.
void UniformRow(Session& session, UiState& state, const ShaderParameter& parameter);

/// A line of a table of facts: label, value.
void FactRow(const UiState& state, const char* label, const std::string& value);

/// Units as people write them: "kg/(m^2 s)" becomes "kg/(m² s)".
std::string Readable(std::string_view unit);

/// Text as wide as the window, broken into lines.
void Wrapped(std::string_view text);

/// Every control is followed by this: it explains the control to whose pointer rests on it, and notes
/// it under that name.
void Control(Session& session, UiState& state, std::string_view name, const std::string& help);

/// A control that opens a list: whether it is open, and ImGui::EndCombo is to be called after its entries.
bool BeginList(Session& session, UiState& state, const std::string& name, const std::string& help,
               const std::string& preview);

/// A button for an action of the table, with its help and key. Returns whether it was pressed.
bool ActionButton(Session& session, UiState& state, std::string_view name);

/// Shows the last item, and lets keys act on it.
void GiveKeyboard(UiState& state);

/// Notes where the last item is, for the log, and whether it has the keyboard.
void NoteBox(const Session& session, UiState& state, std::string_view name);
/// The same for the window that is being made.
void NoteWindow(const Session& session, UiState& state, std::string_view name);

}  // namespace percale::viewer
