// SPDX-License-Identifier: MIT
#include "common/probe/pixel_report.hpp"

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

}  // namespace

std::string words(float number, int digits) { return formatted("%.*g", digits, double{number}); }

std::string words(vec2 v) { return formatted("%.3f %.3f", double{v.x}, double{v.y}); }

std::string words(vec3 v) { return words(dvec3(v)); }

std::string words(dvec3 v) { return formatted("%.3f %.3f %.3f", v.x, v.y, v.z); }

std::string words(ivec2 v) { return formatted("%d, %d", v.x, v.y); }

std::string name_of(const Mesh& mesh, const Triangle& triangle,
                    const std::vector<Material>& materials) {
    const std::string& material = materials[triangle.material].name;
    return (mesh.name.empty() ? "mesh" : shortened(mesh.name)) + " #" +
           std::to_string(&triangle - mesh.triangles.data()) +
           (material.empty() ? "" : " (" + shortened(material) + ")");
}

void PixelReport::section(const std::string& title) {
    text_ += (text_.empty() ? "" : "\n") + title + '\n';
}

void PixelReport::line(const char* name, const std::string& value, const char* equation) {
    std::string line = "  " + padded(name, 22) + ' ' + value;
    if (*equation != '\0') line = padded(line, 80) + "  " + equation;
    text_ += line + '\n';
}

void PixelReport::line(const char* name, float value, const char* equation) {
    line(name, words(value), equation);
}

void PixelReport::line(const char* name, vec3 value, const char* equation) {
    line(name, words(value), equation);
}

void PixelReport::text(const std::string& words) { text_ += "  " + words + '\n'; }

void PixelHistory::missed(const std::string& triangle, const std::string& why) {
    entries_.push_back({triangle, "", "", why, false});
}

void PixelHistory::lost(const std::string& triangle, std::optional<vec3> barycentrics,
                        std::optional<float> depth, const std::string& why) {
    entries_.push_back({triangle, barycentrics ? words(*barycentrics) : "",
                        depth ? words(*depth, 7) : "", why, true});
}

void PixelHistory::written(const std::string& triangle, std::optional<vec3> barycentrics,
                           std::optional<float> depth) {
    if (last_written_) entries_[*last_written_].fate = "written, later overwritten by " + triangle;
    last_written_ = entries_.size();
    lost(triangle, barycentrics, depth, "written, and seen");
}

void PixelHistory::print(PixelReport& report, const std::vector<Mesh>& meshes) const {
    std::size_t triangles = 0;
    for (const Mesh& mesh : meshes) triangles += mesh.triangles.size();
    print(report, "triangles whose box holds the pixel, in drawing order (of " +
                      std::to_string(triangles) + ")");
}

void PixelHistory::print(PixelReport& report, const std::string& title) const {
    report.section(title);
    if (entries_.empty()) return report.text("none");
    constexpr const char* name_title = "mesh #triangle (material)";
    std::string columns = "barycentrics a b c";
    const auto numbers = [](const TriangleInPixel& entry) {
        return padded(entry.barycentrics, 18) + (entry.depth.empty() ? "" : "  " + entry.depth);
    };
    std::size_t name_width = std::string(name_title).size(), width = columns.size();
    std::size_t missed = 0, covering = 0;
    for (const TriangleInPixel& entry : entries_) {
        name_width = std::max(name_width, entry.triangle.size());
        width = std::max(width, numbers(entry).size());
    }
    if (width > columns.size()) columns += "  depth";
    report.text(padded(name_title, name_width) + "  " + columns);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const TriangleInPixel& entry = entries_[i];
        const bool fits = entry.covers ? covering++ < most_covering : missed++ < most_missed;
        if (!fits && i != last_written_) continue;
        report.text(padded(entry.triangle, name_width) + "  " +
                    (entry.covers ? padded(numbers(entry), width) + "  " : "") + entry.fate);
    }
    if (missed > most_missed)
        report.text("and " + std::to_string(missed - most_missed) + " more that do not cover it");
    if (covering > most_covering)
        report.text("and " + std::to_string(covering - most_covering) + " more that cover it");
}

u8vec3 probed_color(const PixelProbe& probe, ivec2 pixel, int samples_per_side,
                    PixelReport& report) {
    const ivec2 first = samples_per_side * pixel;
    Image<vec3> samples{ivec2(samples_per_side)};
    std::string bytes;
    for (int y = 0; y < samples_per_side; ++y)
        for (int x = 0; x < samples_per_side; ++x) {
            PixelReport of_another;
            const bool is_first = x == 0 && y == 0;
            vec3& sample = samples[{x, y}];
            sample = probe(first + ivec2(x, y), is_first ? report : of_another);
            bytes += ' ' + hex(srgb8_from_linear(Image<vec3>({1, 1}, sample))[{0, 0}]);
        }
    const vec3 color = averaged(samples, samples_per_side)[{0, 0}];
    const u8vec3 encoded = srgb8_from_linear(Image<vec3>({1, 1}, color))[{0, 0}];
    report.section("the pixel");
    if (samples_per_side > 1) {
        constexpr std::size_t most = 16 * 8;  // letters: of 16 samples
        report.line("samples", bytes.substr(1, most - 1) + (bytes.size() > most ? " ..." : ""));
        report.line("their mean, linear", color);
    } else {
        report.line("colour, linear", color);
    }
    report.line("sRGB-encoded", std::to_string(encoded.r) + ' ' + std::to_string(encoded.g) + ' ' +
                                    std::to_string(encoded.b));
    return encoded;
}

std::string explained(const PixelProbe& probe, ivec2 pixel, int samples_per_side, u8vec3 drawn) {
    PixelReport report;
    report.section("pixel " + words(pixel) +
                   (samples_per_side == 1
                        ? ""
                        : ": the first of its " +
                              std::to_string(samples_per_side * samples_per_side) + " samples"));
    const u8vec3 color = probed_color(probe, pixel, samples_per_side, report);
    if (color != drawn)
        report.text(
            "The picture has another colour: by an option such as --depth, or by main.cpp, which "
            "puts these stages together.");
    return report.all() + hex(drawn) + '\n';
}

}  // namespace rasterbook
