#include "apps/viewer/undo.h"

#include <doctest/doctest.h>

using namespace percale;
using namespace percale::viewer;

namespace {

Scene WithKs(double ks) {
  Scene scene;
  scene.cloths.resize(1);
  scene.cloths[0].ks = ks;
  return scene;
}

Change KsChange(double before, double after) {
  return {.label = "Spring constant", .path = "/cloth/ks", .before = WithKs(before), .after = WithKs(after)};
}

}  // namespace

TEST_CASE("changes are taken back in order and made again, until something new is done") {
  UndoStack stack;
  CHECK(stack.ToUndo() == nullptr);
  stack.Push(KsChange(1, 2));
  stack.Push(KsChange(2, 3));
  REQUIRE(stack.ToUndo());
  CHECK(stack.ToUndo()->before.cloths[0].ks == 2);
  stack.Undone(0);
  CHECK(stack.ToUndo()->before.cloths[0].ks == 1);
  CHECK(stack.ToRedo()->after.cloths[0].ks == 3);
  stack.Undone(0);
  CHECK(stack.ToUndo() == nullptr);
  stack.Redone(0);
  CHECK(stack.ToUndo()->after.cloths[0].ks == 2);
  stack.Push(KsChange(2, 9));
  CHECK(stack.ToRedo() == nullptr);
  CHECK(stack.ToUndo()->after.cloths[0].ks == 9);
}

TEST_CASE("what changes while a control is held is one change") {
  UndoStack stack;
  stack.Push(KsChange(1, 2));
  CHECK_FALSE(stack.Merges("/cloth/ks"));  // Nothing is held.
  stack.Hold(true);
  CHECK_FALSE(stack.Merges("/cloth/ks"));  // What was done before it is another change.
  stack.Push(KsChange(2, 3));
  CHECK(stack.Merges("/cloth/ks"));
  CHECK_FALSE(stack.Merges("/cloth/density"));
  stack.Extend(WithKs(4));
  stack.Hold(false);
  stack.Hold(true);
  CHECK_FALSE(stack.Merges("/cloth/ks"));
  CHECK(stack.ToUndo()->before.cloths[0].ks == 2);
  CHECK(stack.ToUndo()->after.cloths[0].ks == 4);
}

TEST_CASE("the command that leads back changes with each step") {
  UndoStack stack;
  stack.Push({.label = "Drag", .command = 7});
  CHECK(stack.ToUndo()->command == 7);
  stack.Undone(12);
  CHECK(stack.ToRedo()->command == 12);
  stack.Redone(15);
  CHECK(stack.ToUndo()->command == 15);
}

TEST_CASE("the oldest of too many changes are forgotten") {
  UndoStack stack;
  for (std::size_t i = 0; i < UndoStack::kMost + 5; ++i) stack.Push(KsChange(double(i), double(i) + 1));
  std::size_t count = 0;
  for (; stack.ToUndo(); ++count) {
    if (count + 1 == UndoStack::kMost) CHECK(stack.ToUndo()->before.cloths[0].ks == 5);
    stack.Undone(0);
  }
  CHECK(count == UndoStack::kMost);
}

TEST_CASE("a change is made to what it changed, whatever else is other by now") {
  Scene now = WithKs(2);
  now.cloths[0].damping = 0.7;
  now.look.shader = "Phong";
  const Scene back = WithChange(now, WithKs(2), WithKs(1));
  CHECK(back.cloths[0].ks == 1);
  CHECK(back.cloths[0].damping == 0.7);
  CHECK(back.look.shader == "Phong");

  // A pin that the grid does not have any more; a cloth that is not there any more.
  Scene pinned = WithKs(2);
  pinned.cloths[0].pinned = {{49, 49}};
  now.cloths[0].numWidthPoints = 10;
  CHECK(WithChange(now, WithKs(2), pinned).cloths[0].numWidthPoints == pinned.cloths[0].numWidthPoints);
  now.cloths.clear();
  CHECK(WithChange(now, WithKs(2), WithKs(1)).cloths.size() == 1);
}
