#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"
#include "core/index.h"
#include "core/text.h"
#include "mesh/cloth_model.h"
#include "mesh/pick.h"
#include "world/measure.h"

namespace percale::viewer {
namespace {

constexpr float kOffset = 18;                             // of the window from the vertex [screen unit at scale 1]
constexpr ImU32 kRingColor = IM_COL32(230, 159, 0, 255);  // orange of Okabe and Ito

/// The cloths' vertex nearest to where the pointer's ray meets them first.
std::optional<VertexRef> PickVertex(const Session& session, double x, double y, int width, int height) {
  const OrbitCamera& camera = session.view().camera;
  const Ray ray{camera.position(), camera.Ray(x, y, width, height)};
  std::optional<VertexRef> vertex;
  double nearest = 0;
  const Snapshot& snapshot = session.snapshot();
  for (std::size_t c = 0; c < snapshot.cloths.size(); ++c) {
    const std::optional<Hit> hit = PickCloth(ray, snapshot.cloths[c].positions, snapshot.cloths[c].topology->triangles);
    if (!hit || (vertex && hit->distance >= nearest)) continue;
    nearest = hit->distance;
    vertex = VertexRef{static_cast<int>(c), hit->vertex};
  }
  return vertex;
}

bool Exists(const Snapshot& snapshot, const VertexRef& ref) {
  return ref.cloth >= 0 && Index(ref.cloth) < snapshot.cloths.size() &&
         Index(ref.vertex) < snapshot.cloths[Index(ref.cloth)].positions.size();
}

void Facts(const Session& session, const UiState& state, const VertexRef& ref) {
  const Snapshot& snapshot = session.snapshot();
  const ClothCopy& cloth = snapshot.cloths[Index(ref.cloth)];
  const ClothTopology& topology = *cloth.topology;
  const ClothSettings& settings = snapshot.scene->cloths[Index(ref.cloth)];
  const Vec3& at = cloth.positions[Index(ref.vertex)];
  const auto fact = [&](const char* label, const std::string& value) { FactRow(state, label, value); };
  fact("Vertex", Text("%d of cloth %d", ref.vertex, ref.cloth));
  const GridPoint point = PointOf(settings, ref.vertex);
  if (settings.shape == Shape::Grid)
    fact("Grid", Text("i %d, j %d", point.i, point.j));
  else if (settings.shape == Shape::Mesh)
    fact("In the file", Text("%d, from 0", point.i));
  fact("Position", Text("%.4f, %.4f, %.4f m", at.x, at.y, at.z));
  fact("Speed", Text("%.4g m/s", Length(cloth.velocities[Index(ref.vertex)])));

  double greatest = 0, least = 0;
  int springs = 0;
  for (std::size_t s = 0; s < topology.springs.size(); ++s) {
    const Edge& spring = topology.springs[s];
    if (spring.a != ref.vertex && spring.b != ref.vertex) continue;
    const double rest = topology.restLengths[s];
    const double ratio = Length(cloth.positions[Index(spring.a)] - cloth.positions[Index(spring.b)]) / rest;
    greatest = springs == 0 ? ratio : std::max(greatest, ratio);
    least = springs == 0 ? ratio : std::min(least, ratio);
    ++springs;
  }
  fact("Stretch", springs == 0 ? "no springs" : Text("%.4f to %.4f in %d springs", least, greatest, springs));
  const bool pinned = std::binary_search(topology.pinned.begin(), topology.pinned.end(), ref.vertex);
  fact("Pinned", pinned ? "yes" : "no");

  std::vector<ContactCloth> cloths;
  for (std::size_t c = 0; c < snapshot.cloths.size(); ++c) {
    cloths.push_back(
        {snapshot.cloths[c].positions, snapshot.cloths[c].topology->rest, snapshot.scene->cloths[c].thickness});
  }
  const std::vector<PlacedSolid> solids = SolidsAt(*snapshot.scene, snapshot.report.time, snapshot.balls);
  const ContactCount contacts = CountContacts(ref, cloths, solids);
  fact("Contacts", Text("%d cloth, %d colliders", contacts.cloth, contacts.colliders));
}

}  // namespace

void DrawInspector(Session& session, UiState& state, int pictureWidth, int height) {
  if (!state.inspectorVisible) return;
  const Snapshot& snapshot = session.snapshot();
  const ImGuiIO& io = ImGui::GetIO();
  const bool inPicture = !io.WantCaptureMouse && io.MousePos.x >= 0 && io.MousePos.y >= 0 &&
                         io.MousePos.x < static_cast<float>(pictureWidth);
  const bool dragging = io.MouseDown[0] || io.MouseDown[1];
  if (!state.inspectorHeld) {
    state.inspected = {};
    if (inPicture && !dragging) {
      const auto found = PickVertex(session, static_cast<double>(io.MousePos.x), static_cast<double>(io.MousePos.y),
                                    pictureWidth, height);
      state.inspected = found.value_or(VertexRef{});
    }
  }
  if (!Exists(snapshot, state.inspected)) return;
  const Vec3& at = snapshot.cloths[Index(state.inspected.cloth)].positions[Index(state.inspected.vertex)];
  const Vec3 clip = TransformPoint(session.view().camera.ViewProjection(pictureWidth, height), at);
  const ImVec2 point{static_cast<float>((clip.x + 1) / 2 * pictureWidth),
                     static_cast<float>((1 - clip.y) / 2 * height)};
  ImGui::GetBackgroundDrawList()->AddCircle(point, 6 * state.scale, kRingColor, 0, 2 * state.scale);
  // Above or below the vertex, where there is more room; within the picture.
  const float offset = kOffset * state.scale, *size = state.inspectorSize;
  const bool above = point.y > static_cast<float>(height) / 2;
  const float left = std::min(point.x + offset, static_cast<float>(pictureWidth) - size[0]);
  ImGui::SetNextWindowPos({std::max(left, 0.0f), above ? point.y - offset - size[1] : point.y + offset});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav |
                                      ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings;
  if (ImGui::Begin("Inspector", nullptr, kFlags)) {
    NoteWindow(session, state, "inspector");
    Facts(session, state, state.inspected);
    state.inspectorSize[0] = ImGui::GetWindowWidth();
    state.inspectorSize[1] = ImGui::GetWindowHeight();
  }
  ImGui::End();
  if (state.inspectedLogged.cloth != state.inspected.cloth || state.inspectedLogged.vertex != state.inspected.vertex) {
    state.inspectedLogged = state.inspected;
    session.log().Write(
        LogLine("inspect").Number("cloth", state.inspected.cloth).Number("vertex", state.inspected.vertex));
  }
}

}  // namespace percale::viewer
