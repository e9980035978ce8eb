// SPDX-License-Identifier: MIT
#include "common/probe/pixel_trace.hpp"

#include <algorithm>
#include <cstdio>

#include "common/math/color.hpp"

namespace rasterbook {

namespace {

constexpr std::size_t most_missed = 4, most_covering = 24;

template <typename... Numbers>
std::string formatted(const char* format, Numbers... numbers) {
    char text[128];
    std::snprintf(text, sizeof text, format, numbers...);
    return text;
}

/// With spaces behind it, so that columns stand below each other.
std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, text.size()), ' ');
}

/// Names come from files, and may be of any length.
std::string shortened(const std::string& name) {
    constexpr std::size_t longest = 24;
    return name.size() <= longest ? name : name.substr(0, longest - 3) + "...";
}

std::string hex(u8vec3 color) {
    return formatted("#%02x%02x%02x", unsigned{color.r}, unsigned{color.g}, unsigned{color.b});
}

u8vec3 encoded(vec3 linear) { return srgb8_from_linear(Image<vec3>({1, 1}, linear))[{0, 0}]; }

std::string line_of(const std::string& name, const std::string& value, const char* equation = "") {
    std::string line = "  " + padded(name, 22) + ' ' + value;
    if (*equation != '\0') line = padded(line, 80) + "  " + equation;
    return line + '\n';
}

}  // namespace

std::string words(float number, int digits) { return formatted("%.*g", digits, double{number}); }

std::string words(vec2 v) { return formatted("%.3f %.3f", double{v.x}, double{v.y}); }

std::string words(vec3 v) { return words(dvec3(v)); }

std::string words(dvec3 v) { return formatted("%.3f %.3f %.3f", v.x, v.y, v.z); }

std::string words(ivec2 v) { return formatted("%d, %d", v.x, v.y); }

void PixelTrace::update() { takes_notes = !is_muted_ && (current_ != none || is_of_section_); }

bool PixelTrace::mute(bool is_muted) {
    const bool before = std::exchange(is_muted_, is_muted);
    update();
    return before;
}

void PixelTrace::leave() {
    current_ = none, is_of_section_ = false;
    update();
}

void PixelTrace::add(TriangleInPixel triangle) {
    if (is_muted_) return;
    leave();
    if (triangle.barycentrics) current_ = triangles_.size();
    if (sections_.empty() || triangle.barycentrics) triangles_.push_back(std::move(triangle));
    update();
}

bool PixelTrace::find(const std::array<ivec2, 3>& vertices) {
    if (is_muted_) return false;
    leave();
    for (std::size_t i = triangles_.size(); i-- > 0;) {  // of equal ones, the next to be filled
        const TriangleInPixel& of = triangles_[i];
        const bool is_first = current_ == none || !of.is_filled;
        if (of.barycentrics && of.vertices == vertices && is_first) current_ = i;
    }
    update();
    return current_ != none;
}

void PixelTrace::find_written(const std::array<ivec2, 3>& vertices) {
    leave();
    for (std::size_t i = 0; i < triangles_.size(); ++i)
        if (triangles_[i].is_written && triangles_[i].vertices == vertices) current_ = i;
    update();
}

void PixelTrace::begin_fragment() {
    mute(false);
    triangles_[current_].is_filled = true;
    nearest_ = nullptr;
}

void PixelTrace::compare_depth(const float& nearest, float depth) {
    std::optional<float>& known = triangles_[current_].depth;
    if (!known) line("depth", words(depth, 7), "Eq. 3.3");
    known = depth;
    nearest_ = &nearest, before_ = nearest;
}

void PixelTrace::end_as(std::string fate) { triangles_[current_].fate = std::move(fate); }

void PixelTrace::blend(float opacity, vec3 color) {
    end_as("blended over what lies behind, opacity " + words(opacity) + " (Eq. 11.6)");
    triangles_[current_].blended = vec4(color, opacity);
}

void PixelTrace::end_fragment() {
    mute(true);
    TriangleInPixel& of = triangles_[current_];
    if (!of.fate.empty()) return;
    of.is_written = !nearest_ || *nearest_ != before_;
    if (of.is_written)
        of.fate = "written";
    else if (!(*of.depth > before_))
        of.fate = "behind: not nearer than " + words(before_, 7) + " (Eq. 3.1)";
    else
        of.fate = "not written";
}

void PixelTrace::line(const char* name, const std::string& value, const char* equation) {
    std::string& lines = is_of_section_ ? sections_.back().lines : triangles_[current_].lines;
    lines += line_of(name, value, equation);
}

void PixelTrace::line_of_position(vec3 position) {
    line("position in the world", words(scene_.origin + dvec3(position)), "Eq. 5.1");
}

void PixelTrace::begin_section(const std::string& title) {
    sections_.push_back({title, triangles_.size()});
    leave();
    is_of_section_ = true;
    update();
}

std::string PixelTrace::name_of(const Mesh& mesh, const Triangle& triangle) const {
    const std::string& material = scene_.materials[triangle.material].name;
    return (mesh.name.empty() ? "mesh" : shortened(mesh.name)) + " #" +
           std::to_string(&triangle - mesh.triangles.data()) +
           (material.empty() ? "" : " (" + shortened(material) + ")");
}

std::string PixelTrace::history(const std::string& title, std::size_t begin,
                                std::size_t end) const {
    std::string text = title + '\n';
    if (begin == end) return text + "  none\n";
    constexpr const char* name_title = "mesh #triangle (material)";
    std::string columns = "barycentrics a b c";
    const auto numbers = [](const TriangleInPixel& of) {
        return padded(words(*of.barycentrics), 18) + (of.depth ? "  " + words(*of.depth, 7) : "");
    };
    std::size_t name_width = std::string(name_title).size(), width = columns.size(), last = end;
    for (std::size_t i = begin; i < end; ++i) {
        name_width = std::max(name_width, triangles_[i].name.size());
        if (triangles_[i].barycentrics) width = std::max(width, numbers(triangles_[i]).size());
        if (triangles_[i].is_written) last = i;
    }
    if (width > columns.size()) columns += "  depth";
    text += "  " + padded(name_title, name_width) + "  " + columns + '\n';
    std::size_t missed = 0, covering = 0;
    for (std::size_t i = begin; i < end; ++i) {
        const TriangleInPixel& of = triangles_[i];
        const bool fits = of.barycentrics ? covering++ < most_covering : missed++ < most_missed;
        if (!fits && i != last) continue;
        std::string fate = of.fate;
        if (i == last) fate += ", and seen";
        if (of.is_written && i != last) {
            std::size_t next = i + 1;
            while (!triangles_[next].is_written) ++next;
            fate += ", later overwritten by " + triangles_[next].name;
        }
        if (fate.empty()) fate = of.is_front_facing ? "not drawn" : "faces away (Eq. 2.2)";
        text += "  " + padded(of.name, name_width) + "  " +
                (of.barycentrics ? padded(numbers(of), width) + "  " : "") + fate + '\n';
    }
    if (missed > most_missed)
        text += "  and " + std::to_string(missed - most_missed) + " more that do not cover it\n";
    if (covering > most_covering)
        text += "  and " + std::to_string(covering - most_covering) + " more that cover it\n";
    return text;
}

std::string PixelTrace::seen(std::size_t end) const {
    while (end-- > 0)
        if (triangles_[end].is_written)
            return "\nseen: " + triangles_[end].name + '\n' + triangles_[end].lines;
    return "\nseen: the background, since no triangle is written here\n";
}

std::string PixelTrace::blending(std::size_t end) const {
    std::vector<const TriangleInPixel*> blended;  // from back to front
    for (std::size_t i = 0; i < end; ++i)
        if (triangles_[i].blended) blended.push_back(&triangles_[i]);
    if (blended.empty()) return "";
    std::sort(blended.begin(), blended.end(), [](const auto* a, const auto* b) {
        return a->depth < b->depth || (a->depth == b->depth && a > b);
    });
    std::string text = "\nseen through, the nearest: " + blended.back()->name + '\n' +
                       blended.back()->lines + "\nblended from back to front (Eq. 11.7 and 11.8)\n";
    for (const TriangleInPixel* of : blended)
        text += line_of("over what is behind", words(vec3(*of->blended)) + ", opacity " +
                                                   words(of->blended->a) + ", of " + of->name);
    return text;
}

std::string PixelTrace::in_words(const Image<vec3>& picture, int samples_per_side) const {
    const ivec2 pixel = pixel_ / samples_per_side;
    std::string text = "pixel " + words(pixel);
    if (samples_per_side > 1)
        text += ": the first of its " + std::to_string(samples_per_side * samples_per_side) +
                " samples";
    std::size_t triangles = 0;
    for (const Mesh& mesh : scene_.meshes) triangles += mesh.triangles.size();
    const std::size_t end = sections_.empty() ? triangles_.size() : sections_[0].first;
    text += "\n\n" +
            history("triangles whose box holds the pixel, in drawing order (of " +
                        std::to_string(triangles) + ")",
                    0, end) +
            seen(end) + blending(end);
    for (std::size_t i = 0; i < sections_.size(); ++i) {
        const TracedSection& section = sections_[i];
        const std::size_t last =
            i + 1 < sections_.size() ? sections_[i + 1].first : triangles_.size();
        text += '\n' + (section.lines.empty() ? history(section.title, section.first, last)
                                              : section.title + '\n' + section.lines);
    }

    Image<vec3> samples{ivec2(samples_per_side)};
    std::string bytes;
    for (int y = 0; y < samples_per_side; ++y)
        for (int x = 0; x < samples_per_side; ++x) {
            samples[{x, y}] = picture[pixel_ + ivec2(x, y)];
            bytes += ' ' + hex(encoded(samples[{x, y}]));
        }
    const vec3 color = averaged(samples, samples_per_side)[{0, 0}];
    const u8vec3 stored = encoded(color);
    text += "\nthe pixel\n";
    if (samples_per_side > 1) {
        constexpr std::size_t most = 16 * 8;  // letters: of 16 samples
        text += line_of("samples", bytes.substr(1, most - 1) + (bytes.size() > most ? " ..." : ""));
        text += line_of("their mean, linear", words(color));
    } else {
        text += line_of("colour, linear", words(color));
    }
    return text +
           line_of("sRGB-encoded", std::to_string(stored.r) + ' ' + std::to_string(stored.g) + ' ' +
                                       std::to_string(stored.b)) +
           hex(stored) + '\n';
}

void note(const char* name, const std::string& value, const char* equation) {
    pixel_trace->line(name, value, equation);
}
void note(const char* name, const char* value, const char* equation) {
    pixel_trace->line(name, value, equation);
}
void note(const char* name, int value, const char* equation) {
    pixel_trace->line(name, std::to_string(value), equation);
}
void note(const char* name, float value, const char* equation) {
    pixel_trace->line(name, words(value), equation);
}
void note(const char* name, vec2 value, const char* equation) {
    pixel_trace->line(name, words(value), equation);
}
void note(const char* name, vec3 value, const char* equation) {
    pixel_trace->line(name, words(value), equation);
}
void note_position(vec3 position_world) { pixel_trace->line_of_position(position_world); }
void note_depth(const float* nearest, float depth) { pixel_trace->compare_depth(*nearest, depth); }

std::string explained(const std::function<Image<vec3>()>& draw, ivec2 pixel, int samples_per_side,
                      const Scene& scene) {
    PixelTrace trace(samples_per_side * pixel, scene);
    pixel_trace = &trace;
    const Image<vec3> picture = draw();
    pixel_trace = nullptr, takes_notes = false;
    return trace.in_words(picture, samples_per_side);
}

}  // namespace rasterbook
