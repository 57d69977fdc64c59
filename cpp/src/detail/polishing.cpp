// SPDX-License-Identifier: MIT
#include "detail/polishing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pectinate::detail {
namespace {

/// A change for the worse is accepted with the probability exp(-loss / temperature), in mean lengths; after so many
/// rounds a line the temperature is half of what it was at first, after twice as many a third, and so on.
constexpr double first_temperature = 0.3, rounds_to_half = 4;
/// What the sum of the squared lengths, over the mean length, counts beside the length: else the longest would suffer.
constexpr double weight_of_squares = 0.02;
/// Share of the rounds in which a line grows past what it rests on; in the others a short one is taken away.
constexpr double share_of_growth = 0.5;
/// Of so many lines drawn the shortest is taken away.
constexpr int most_drawn = 3;
/// How likely what a short line rests on goes with it, and how likely lines that rest on others go with those.
constexpr double share_of_supports = 0.4, share_of_resting = 0.5;
/// In mean lengths: to trace longer lines again takes long and gains little. Of a line that is to grow and what it
/// rests on, together, and of lines that rest on others.
constexpr double longest_to_grow = 5, longest_resting = 4;
/// Share of the rounds in which a line much longer than the others, in mean lengths, gives way; how much of it at most.
constexpr double share_of_giving_way = 0.3, least_to_give_way = 5, most_given = 0.95;
/// Ends that lost what they rested on are mended so many times, or the round is undone.
constexpr int most_mendings = 8;
/// So many times as many lines as there are may be replaced without getting better, before it goes back to the best.
constexpr std::size_t most_replaced = 4;
/// Less is no gain in mean length, relative to it, and no loss of coverage.
constexpr double least_gain = 1e-9, least_uncovered = 1e-7;

bool contains(const std::vector<std::int32_t>& lines, std::int32_t line) {
  return std::ranges::find(lines, line) != lines.end();
}

ChordPlace middle_of(std::span<const Chord> chords) {
  const auto& chord = chords[chords.size() / 2];
  return {chord.triangle(), chord.coordinate};
}

void add_once(std::int32_t line, std::vector<std::int32_t>& lines) {
  if (!contains(lines, line)) lines.push_back(line);
}

}  // namespace

Polisher::Polisher(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const LineRules& rules,
                   ChordOccupancy& occupancy, std::uint64_t random_seed)
    : mesh_(mesh),
      sheet_(tracer.sheet()),
      lines_(tracer.sheet()),
      filler_(mesh, tracer, rules, occupancy,
              [this](const PlacedLine& line) {
                lines_.place(current_, line);
                placed_.push_back(current_);
              }),
      occupancy_(occupancy),
      layers_(mesh, tracer, occupancy),
      centres_(mesh, tracer, occupancy.clearance().stop),
      random_(random_seed),
      rounds_(mesh.triangle_count(), 0) {}

bool Polisher::fill(const std::function<bool()>& go_on) {
  filler_.mark_with([this](const Polyline& line) -> const Numbers& {
    current_ = lines_.new_number();
    occupancy_.add(line);
    return occupancy_.changed();
  });
  return filler_.fill(go_on);
}

std::int64_t Polisher::polish(const std::function<bool(std::int64_t)>& go_on) {
  Polyline polyline;
  for (const auto line : lines_.present()) {
    const auto& held = lines_[line];
    polyline.follow(sheet_, held.chords, held.is_closed);
    layers_.add(line, polyline);
    centres_.add(line, polyline, layers_.triangles(line));
    total_length_ += held.length;
  }
  filler_.mark_with([this](const Polyline& line) -> const Numbers& {
    current_ = lines_.new_number();
    layers_.add(current_, line);
    centres_.add(current_, line, layers_.triangles(current_));
    return layers_.triangles(current_);
  });
  least_length_ = total_length_;
  rounds_at_half_ = rounds_to_half * static_cast<double>(lines_.present().size());
  tolerance_ = least_uncovered * mesh_.area();
  uncovered_at_first_ = centres_.uncovered_area();
  settle();
  std::int64_t count = 0;
  for (; lines_.present().size() > 1 && go_on(count); ++count) play_round();
  go_back();
  return count;
}

void Polisher::for_each(const std::function<void(const PlacedLine&)>& place) const {
  auto numbers = lines_.present();
  std::ranges::sort(numbers, {}, [&](std::int32_t line) { return lines_[line].rank; });
  for (const auto line : numbers) place(lines_.placed(line));
}

void Polisher::play_round() {
  first_.clear();
  taken_out_.clear();
  placed_.clear();
  freed_.clear();
  free_before_ = 0;
  uncovered_before_ = centres_.uncovered_area();
  ++round_;
  if (!let_long_line_give_way()) replace(choose(), first_, true);
  const bool is_whole = mend_loose_ends();
  auto change = finished_change();
  const auto effect = effect_of(change);
  if (is_whole && accepts(effect)) {
    keep(std::move(change), effect);
  } else {
    undo(change);
  }
}

// Choice --------------------------------------------------------------------------------------------------------------

std::vector<std::int32_t> Polisher::choose() {
  auto chosen = random_.unit() < share_of_growth ? choose_to_grow() : Numbers{};
  if (chosen.empty()) chosen = choose_short();
  if (random_.unit() < share_of_resting) choose_resting(chosen);
  return chosen;
}

/// A line that rests on others at an end, and those; it will come back first, and longer. Or none.
std::vector<std::int32_t> Polisher::choose_to_grow() {
  const auto line = draw_line();
  const auto end = static_cast<std::size_t>(random_.below(2));
  const auto& beyond = lines_[line].beyond[end];
  if (!beyond) return {};
  Numbers chosen{line};
  for (const auto other : layers_.takers(beyond->triangle, beyond->coordinate)) add_once(other, chosen);
  double length = 0;
  for (const auto one : chosen) length += lines_[one].length;
  if (length > longest_to_grow * mean_length()) return {};
  first_.push_back(middle_of(lines_[line].chords));
  return chosen;
}

/// A short line, and maybe what it rests on.
std::vector<std::int32_t> Polisher::choose_short() {
  const auto line = draw_short_line();
  Numbers chosen{line};
  for (const auto& beyond : lines_[line].beyond) {
    if (!beyond || random_.unit() >= share_of_supports) continue;
    for (const auto other : layers_.takers(beyond->triangle, beyond->coordinate)) add_once(other, chosen);
  }
  return chosen;
}

std::int32_t Polisher::draw_short_line() {
  auto shortest = draw_line();
  for (int drawn = 1; drawn < most_drawn; ++drawn) {
    const auto line = draw_line();
    if (lines_[line].length < lines_[shortest].length) shortest = line;
  }
  return shortest;
}

/// And the lines that could go on without those chosen.
void Polisher::choose_resting(Numbers& chosen) {
  const auto supports = chosen;
  for (const auto line : supports) {
    for (const auto t : layers_.triangles(line)) {
      for (const auto other : lines_.ending_before(t)) {
        if (lines_[other].length > longest_resting * mean_length()) continue;
        if (rests_on(other, t, supports)) add_once(other, chosen);
      }
    }
  }
}

/// Is an end of a line kept from going on into a triangle by these lines alone?
bool Polisher::rests_on(std::int32_t line, std::int32_t triangle, const Numbers& supports) const {
  return std::ranges::any_of(lines_[line].beyond, [&](const auto& beyond) {
    return beyond && beyond->triangle == triangle &&
           std::ranges::all_of(layers_.takers(triangle, beyond->coordinate),
                               [&](auto taker) { return taker == line || contains(supports, taker); });
  });
}

/// Longer lines more often.
std::int32_t Polisher::draw_by_length() {
  double rest = random_.unit() * total_length_;
  for (const auto line : lines_.present()) {
    rest -= lines_[line].length;
    if (rest < 0) return line;
  }
  return lines_.present().back();
}

// Repair --------------------------------------------------------------------------------------------------------------

/// Takes lines out; the region that they leave.
FreedRegion Polisher::take_out(const Numbers& lines, std::vector<ChordPlace> first, bool at_random) {
  for (const auto line : lines) {
    note_free(line);
    lines_.take_out(line);
    taken_out_.push_back(line);
  }
  centres_.take_back(lines);
  return {layers_.take_back(lines), std::move(first), [this, at_random](const Interval& gap) {
            const double share = at_random ? random_.unit() : 0.5;
            return gap.low + share * (gap.high - gap.low);
          }};
}

/// Takes lines out and fills what they leave.
void Polisher::replace(const Numbers& lines, std::vector<ChordPlace> first, bool at_random) {
  filler_.refill(take_out(lines, std::move(first), at_random));
}

/// Where one line is much longer than the others, these are what is left beside it: it leaves an end to them and to
/// what may grow there, and comes back when they are there. False if no such line was drawn.
bool Polisher::let_long_line_give_way() {
  if (random_.unit() >= share_of_giving_way) return false;
  const auto line = draw_by_length();
  const double length = lines_[line].length;
  if (lines_[line].is_closed || length < least_to_give_way * mean_length()) return false;
  const auto kept = without_end(line, random_.unit() * most_given * length);
  if (kept.empty()) return false;
  const ChordPlace middle = middle_of(kept);
  Numbers chosen{line};
  choose_resting(chosen);
  auto region = take_out(chosen, {}, true);
  const auto place_holder = lines_.new_number();
  Polyline polyline;
  polyline.follow(sheet_, kept, false);
  layers_.add(place_holder, polyline);
  filler_.refill(region);
  layers_.take_back(Numbers{place_holder});
  lines_.forget(place_holder);
  region.first = {middle};
  filler_.refill(region);
  return true;
}

/// The chords of a line but for so much of it at one of its ends.
std::vector<Chord> Polisher::without_end(std::int32_t line, double length) {
  auto chords = lines_[line].chords;
  const bool at_first = random_.below(2) == 0;
  if (at_first) std::ranges::reverse(chords);
  for (; length > 0 && !chords.empty(); chords.pop_back()) length -= chords.back().length;
  if (at_first) std::ranges::reverse(chords);
  return chords;
}

/// Before a line is taken out. Where lines placed in this round lie already, that may count too little.
void Polisher::note_free(std::int32_t line) {
  for (const auto t : layers_.triangles(line)) {
    if (rounds_[t] == round_) continue;
    rounds_[t] = round_;
    freed_.push_back(t);
    free_before_ += free_area(t);
  }
}

double Polisher::free_area(std::int32_t triangle) const {
  if (occupancy_.stopped().is_full(triangle)) return 0;
  return occupancy_.uncovered_share(triangle) * mesh_.triangle_areas()[sheet_.mesh_triangle(triangle)];
}

/// Lines that ended near one that is no more are traced again; false where that comes to no end.
bool Polisher::mend_loose_ends() {
  for (int i = 0; i < most_mendings; ++i) {
    const auto loose = loose_lines();
    if (loose.empty()) return true;
    std::vector<ChordPlace> first;
    for (const auto line : loose) first.push_back(middle_of(lines_[line].chords));
    replace(loose, std::move(first), false);
  }
  return false;
}

std::vector<std::int32_t> Polisher::loose_lines() const {
  Numbers loose;
  for (const auto t : freed_) {
    for (const auto line : lines_.ending_before(t)) {
      for (const auto& beyond : lines_[line].beyond) {
        if (!beyond || beyond->triangle != t) continue;
        if (!layers_.is_taken_by_other(line, t, beyond->coordinate)) add_once(line, loose);
      }
    }
  }
  return loose;
}

// Acceptance ----------------------------------------------------------------------------------------------------------

/// Of the round played; what it placed and took out again is forgotten.
Polisher::Change Polisher::finished_change() {
  Change change;
  for (const auto line : placed_) {
    if (!lines_.is_out(line)) change.come.push_back(line);
  }
  for (const auto line : taken_out_) {
    if (contains(placed_, line)) {
      lines_.forget(line);
    } else {
      change.gone.push_back(line);
    }
  }
  return change;
}

Polisher::Effect Polisher::effect_of(const Change& change) const {
  Effect effect;
  const auto count = [&](std::int32_t line, double sign) {
    const double length = lines_[line].length;
    effect.count += sign;
    effect.length += sign * length;
    effect.squares += sign * length * length;
  };
  for (const auto line : change.come) count(line, 1);
  for (const auto line : change.gone) count(line, -1);
  for (const auto t : freed_) effect.free += free_area(t);
  effect.free -= free_before_;
  effect.uncovered = centres_.uncovered_area() - uncovered_before_;
  return effect;
}

bool Polisher::accepts(const Effect& effect) {
  const double chance = random_.unit();  // always drawn
  if (effect.length < 0 && total_length_ + effect.length < least_length_) return false;
  if (effect.free > 0 && free_ + effect.free > tolerance_) return false;
  if (effect.uncovered > 0 && centres_.uncovered_area() > uncovered_at_first_ + tolerance_) return false;
  const double count_before = static_cast<double>(lines_.present().size()) - effect.count;
  const double mean = total_length_ / count_before;
  const double temperature = first_temperature / (1 + static_cast<double>(round_) / rounds_at_half_);
  const double gain = effect.length - mean * effect.count + weight_of_squares * effect.squares / mean;
  return gain >= 0 || chance < std::exp(gain / (temperature * mean));
}

void Polisher::undo(const Change& change) {
  for (const auto line : change.come) {
    lines_.take_out(line);
    lines_.forget(line);
  }
  layers_.take_back(change.come);
  layers_.put_back(change.gone);
  centres_.take_back(change.come);
  centres_.put_back(change.gone);
  for (const auto line : change.gone) lines_.put_back(line);
}

void Polisher::keep(Change change, const Effect& effect) {
  total_length_ += effect.length;
  free_ += effect.free;
  replaced_count_ += change.gone.size();
  changes_.push_back(std::move(change));
  if (mean_length() > best_mean_ * (1 + least_gain)) {
    settle();
  } else if (replaced_count_ > most_replaced * lines_.present().size()) {
    go_back();
  }
}

/// What lies there is the best so far.
void Polisher::settle() {
  for (const auto& change : changes_) {
    for (const auto line : change.gone) lines_.forget(line);
  }
  changes_.clear();
  replaced_count_ = 0;
  best_mean_ = mean_length();
  best_length_ = total_length_;
  best_free_ = free_;
}

void Polisher::go_back() {
  while (!changes_.empty()) {
    undo(changes_.back());
    changes_.pop_back();
  }
  replaced_count_ = 0;
  total_length_ = best_length_;
  free_ = best_free_;
}

}  // namespace pectinate::detail
