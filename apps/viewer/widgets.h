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

/// Text as wide as the window, broken into lines.
void Wrapped(std::string_view text);

/// Notes where the last item is, for the log.
void NoteBox(const Session& session, UiState& state, std::string_view name);
/// The same for a control that comes next, one line high and as wide as set: a drop-down, after
/// which the last item is in its list when that is open.
void NoteNextBox(const Session& session, UiState& state, std::string_view name);
/// The same for the window that is being made.
void NoteWindow(const Session& session, UiState& state, std::string_view name);

}  // namespace percale::viewer
