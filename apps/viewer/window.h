#pragma once
/// \file
/// The window: GLFW and Dear ImGui set up, and what the user did with keys and mouse.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/viewer/actions.h"
#include "percale/diagnostic.h"

struct GLFWwindow;
struct ImGuiContext;

namespace percale::viewer {

struct WindowSettings {
  int width = 1024, height = 800;  ///< On a display of ordinary density [pixel]; larger where it is denser.
  std::optional<std::pair<int, int>> position;  ///< Of its upper left corner [screen unit].
  double uiScale = 0;                           ///< Of text and controls; 0: as the display asks for.
  int samples = 0;                              ///< Per pixel; 0: 4, or 1 where the CPU draws.
  std::string title;
};

struct InputEvent {
  enum class Kind {
    Key,    ///< `key` was pressed.
    Press,  ///< Of a mouse button, at (x, y).
    Release,
    Move,   ///< The pointer is at (x, y) now.
    Wheel,  ///< By `steps`, at (x, y).
    Drop,   ///< Of `file` onto the window.
  } kind = Kind::Move;
  viewer::Key key;
  bool repeated = false;  ///< The key is held.
  enum class Button { Left, Right } button = Button::Left;
  bool control = false;  ///< Ctrl was held at the press.
  bool shift = false;    ///< Shift was.
  double x = 0, y = 0;   ///< [screen unit] from the top left.
  double steps = 0;      ///< Away from the user.
  std::filesystem::path file;
};

class Window {
 public:
  /// Opens a window that is not shown yet, its OpenGL 3.3 core context current. Fails, with what to
  /// do about it, without a display or such a context: exit code 5.
  static Result<Window> Open(const WindowSettings& settings);
  ~Window();
  Window(Window&& other) noexcept;
  Window& operator=(Window&& other) noexcept;

  void Show();
  void Hide();
  /// Waits for input, or Wake, for at most so long; 0: not at all.
  void WaitForEvents(double seconds);
  /// Ends WaitForEvents. The one function that any thread may call.
  static void Wake();
  /// Whether anything has happened to the window since the last call.
  bool TakeActivity();
  /// What the user did since the last call, in order.
  std::vector<InputEvent> TakeEvents();

  /// Starts a picture's panels: Dear ImGui may be called until EndPanels. `keyboard`: arrows, Enter, Space
  /// and Tab move among the controls of the focused panel and use them.
  void BeginPanels(bool keyboard);
  void EndPanels();  ///< Draws them.
  /// Gives the keyboard to the panel window of that name, which has been drawn in this picture; null: to none.
  static void FocusPanels(const char* name);
  /// Whether a point of the window [screen unit] is over a panel, or a list that hangs open will take
  /// the press; as of the panels of the last picture.
  static bool OverPanels(double x, double y);
  /// Whether a list hangs open.
  static bool HasLists();
  /// Closes lists that hang open.
  static void CloseLists();
  /// The same for the control that was drawn last.
  static void FocusLastItem();
  void Present();  ///< Shows the picture.

  bool ShouldClose() const;
  bool Minimized() const;
  void SetTitle(const std::string& title);
  void Size(int& width, int& height) const;             ///< [screen unit]
  void FramebufferSize(int& width, int& height) const;  ///< [pixel]
  /// Position [screen unit], and size as WindowSettings states it.
  void Place(int& x, int& y, int& width, int& height) const;
  int samples() const { return samples_; }  ///< Per pixel, as asked for or chosen.
  float scale() const { return scale_; }    ///< Of text and controls, in screen units.

 private:
  Window() = default;
  static Result<GLFWwindow*> Create(const WindowSettings& settings, int samples);
  struct Callbacks;
  void AdaptToScale();
  void FeedKeys(bool keyboard);

  struct Input {
    std::vector<InputEvent> events;
    bool activity = true;
    bool lastRepeated = false;  // Of the key that the next character belongs to.
    std::vector<int> pressed;   // Keys, since the last picture.
    double x = 0, y = 0;        // Of the pointer, as of the last event.
  };

  GLFWwindow* window_ = nullptr;
  ImGuiContext* context_ = nullptr;
  std::unique_ptr<Input> input_;  // Of a stable address, for the callbacks.
  int samples_ = 1;
  float scale_ = 0;                                                   // Of the present fonts and style.
  float contentScale_ = 0;                                            // Of the display they were made for.
  float uiScale_ = 0;                                                 // As asked for; 0: contentScale_.
  enum class Owner { None, Panels, Text } enterOwner_ = Owner::None;  // Of the Enter key, while it is down.
  std::string title_;
};

}  // namespace percale::viewer
