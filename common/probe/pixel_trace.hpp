// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": what `--probe` says of a pixel. While a picture is drawn, the stages note
/// what they compute there. Neither streams nor files, threads or exceptions are used here, so that
/// it works in a web page, too.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/image/image.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// Numbers as they are printed.
///
/// @param digits  Significant ones of a single number. Vectors have three behind the point.
std::string words(float number, int digits = 4);
std::string words(vec2 numbers);
std::string words(vec3 numbers);
std::string words(dvec3 numbers);
std::string words(ivec2 numbers);

/// A triangle, or a piece that clipping has left of it, whose bounding box holds the pixel.
struct TriangleInPixel {
    std::string name;               ///< "teapot #12 (copper)"
    std::array<ivec2, 3> vertices;  ///< On the screen, in 1/256 pixel.
    vec3 inverse_w{1};              ///< 1/w of its vertices.
    bool is_front_facing;
    std::optional<vec3> barycentrics{};  ///< None: it does not cover the pixel's centre.
    std::string fate{};                  ///< Empty: not known yet.
    std::optional<float> depth{};
    bool is_filled = false, is_written = false;
    std::optional<vec4> blended{};  ///< Colour and opacity.
    std::string lines{};            ///< What has been noted of it.
};

/// What is drawn over all triangles before, in one pixel.
struct TracedSection {
    std::string title;
    std::size_t first;    ///< Of its triangles.
    std::string lines{};  ///< What has been noted of it.
};

/// What happens in one pixel while a picture is drawn, by one thread.
class PixelTrace {
  public:
    /// @param scene  Has to outlive it.
    PixelTrace(ivec2 pixel, const Scene& scene) : pixel_(pixel), scene_(scene) {}

    ivec2 pixel() const { return pixel_; }

    /// Of the pixels that are shaded at once, the number of this one.
    int lane = 0;

    /// The sum of the lights before the one that the notes are about; none where that is turned
    /// away.
    std::optional<vec3> diffuse_before{};
    vec3 specular_before{0};

    /// "teapot #12 (copper)": the mesh, the triangle's number in it, from 0, and its material.
    std::string name_of(const Mesh& mesh, const Triangle& triangle) const;

    /// Adds a triangle, about which the next notes are.
    void add(TriangleInPixel triangle);

    /// The next notes are about the triangle with these vertices; about none, if there is none.
    ///
    /// @return  Whether there is one.
    bool find(const std::array<ivec2, 3>& vertices);

    /// Makes the notes about the triangle with these vertices that is seen; or about none.
    void find_written(const std::array<ivec2, 3>& vertices);

    /// The colour that is blended over what lies behind.
    void blend(float opacity, vec3 color);

    /// Whether notes are left out.
    ///
    /// @return  What it was before.
    bool mute(bool is_muted);
    bool is_muted() const { return is_muted_; }

    /// The next notes are about no triangle.
    void leave();

    /// The triangle's fragment in the pixel is about to be drawn, or has been.
    void begin_fragment();
    void end_fragment();

    /// The fragment's depth is compared with that in a depth buffer.
    void compare_depth(const float& nearest, float depth);

    /// What becomes of the fragment, if it is not written.
    void end_as(std::string fate);

    /// A name, its value, and the equation that the value comes from, such as "Eq. 5.3".
    void line(const char* name, const std::string& value, const char* equation = "");

    /// A position in the scene, as it is in the file's world.
    void line_of_position(vec3 position);

    /// Whether there is such a line of the triangle that the notes are about.
    bool has_line(const std::string& name) const {
        return triangles_[current_].lines.find("  " + name + ' ') != std::string::npos;
    }

    /// What the texture is that is sampled next, once.
    void label_next(const char* name) { label_ = name; }
    std::string take_label(const char* unlabelled) { return std::exchange(label_, unlabelled); }

    /// 1/w of the vertices of the triangle that the notes are about.
    vec3 inverse_w() const { return triangles_[current_].inverse_w; }

    /// What comes next is drawn over all triangles before. The next notes are about the section,
    /// up to a triangle.
    void begin_section(const std::string& title);

    /// All of it, in words.
    ///
    /// @param picture           As it was drawn; linear.
    /// @param samples_per_side  A pixel is the mean of a square of so many samples, of which the
    ///                          first one was traced.
    std::string in_words(const Image<vec3>& picture, int samples_per_side) const;

  private:
    /// Whether notes are taken from now on.
    void update();

    std::string history(const std::string& title, std::size_t begin, std::size_t end) const;
    std::string seen(std::size_t end) const;
    std::string blending(std::size_t end) const;

    ivec2 pixel_;
    const Scene& scene_;
    std::vector<TriangleInPixel> triangles_;  ///< In drawing order.
    std::size_t current_ = none;
    std::vector<TracedSection> sections_;
    bool is_muted_ = false, is_of_section_ = false;
    const float* nearest_ = nullptr;  ///< In a depth buffer; null: no depth was compared.
    float before_ = 0;                ///< The depth there before.

    std::string label_ = "texture";

    static constexpr std::size_t none = ~std::size_t{0};
};

/// Draws a picture, and says why a pixel of it has its colour.
///
/// @param draw              Draws the picture, in one thread; linear.
/// @param pixel             From 0, 0, the upper left one.
/// @param samples_per_side  A pixel is the mean of a square of so many samples.
/// @return  Lines of text; the last one is the pixel as "#rrggbb".
std::string explained(const std::function<Image<vec3>()>& draw, ivec2 pixel, int samples_per_side,
                      const Scene& scene);

/// Of the picture that is being drawn; null: no pixel of it is traced.
inline constinit PixelTrace* pixel_trace = nullptr;
inline constinit bool takes_notes = false;  ///< About what is being computed.

/// Whether a program can answer --probe; whether a pixel of the picture that it draws is traced;
/// and whether what is being computed is to be noted.
#ifdef RASTERBOOK_PROBE
constexpr bool has_probe = true;
inline bool is_probing() { return pixel_trace != nullptr; }
inline bool is_traced() { return takes_notes; }
#else
constexpr bool has_probe = false;
constexpr bool is_probing() { return false; }
constexpr bool is_traced() { return false; }
#endif

/// The number of the traced pixel.
///
/// @param x  A float; or several at once, as common/math/functions.hpp has it.
template <typename F>
float traced_lane(const F& x) {
    if constexpr (std::is_convertible_v<F, float>)
        return static_cast<float>(x);
    else
        return x[pixel_trace->lane];
}
template <glm::length_t n, typename F>
glm::vec<n, float> traced_lane(const glm::vec<n, F>& v) {
    glm::vec<n, float> one;
    for (glm::length_t i = 0; i < n; ++i) one[i] = traced_lane(v[i]);
    return one;
}

/// Notes a value.
[[gnu::cold]] void note(const char* name, const std::string& value, const char* equation);
[[gnu::cold]] void note(const char* name, const char* value, const char* equation);
[[gnu::cold]] void note(const char* name, int value, const char* equation);
[[gnu::cold]] void note(const char* name, float value, const char* equation);
[[gnu::cold]] void note(const char* name, vec2 value, const char* equation);
[[gnu::cold]] void note(const char* name, vec3 value, const char* equation);
[[gnu::cold]] void note_position(vec3 position_world);
[[gnu::cold]] void note_depth(const float* nearest, float depth);

/// Notes a number that a stage has computed, or several, for `--probe`.
///
/// @param value     A number, a vector of them, or words.
/// @param equation  Where it comes from, such as "Eq. 5.3".
template <typename Value>
void trace(const char* name, const Value& value, const char* equation = "") {
    if constexpr (has_probe) {
        if (!is_traced()) return;
        if constexpr (std::is_convertible_v<Value, std::string> || std::is_integral_v<Value>)
            note(name, value, equation);
        else
            note(name, traced_lane(value), equation);
    }
}

/// Notes a position in the world.
template <typename F>
void trace_position(const glm::vec<3, F>& position_world) {
    if constexpr (has_probe)
        if (is_traced()) note_position(traced_lane(position_world));
}

/// Notes that a fragment is blended over what lies behind.
inline void trace_blended(ivec2 pixel, float opacity, vec3 color) {
    if constexpr (has_probe)
        if (is_traced() && pixel == pixel_trace->pixel()) pixel_trace->blend(opacity, color);
}

/// Notes that a fragment lies in a hole.
inline void trace_hole(float opacity, float cutoff) {
    if constexpr (has_probe)
        if (is_traced())
            pixel_trace->end_as("a hole: alpha " + words(opacity) + " is below " + words(cutoff) +
                                " (Eq. 11.6)");
}

/// Notes that a fragment's depth is compared with that in a depth buffer.
inline void trace_depth(const float& nearest, float depth) {
    if constexpr (has_probe)
        if (is_traced()) note_depth(&nearest, depth);
}

/// What comes next is drawn over all before.
inline void trace_section(const char* title) {
    if constexpr (has_probe)
        if (pixel_trace) pixel_trace->begin_section(title);
}

/// While there is one of these, nothing is noted.
class Untraced {
  public:
    Untraced() {
        if constexpr (has_probe)
            if (pixel_trace) was_muted_ = pixel_trace->mute(true);
    }
    ~Untraced() {
        if constexpr (has_probe)
            if (pixel_trace) pixel_trace->mute(was_muted_);
    }
    Untraced(const Untraced&) = delete;
    Untraced& operator=(const Untraced&) = delete;

  private:
    bool was_muted_ = false;
};

/// While there is one of these, a triangle's pixels are filled, and only TracedFragments are noted.
class TracedFill {
  public:
    /// @param vertices  Of the triangle on the screen.
    explicit TracedFill(const std::array<ivec2, 3>& vertices) {
        if constexpr (has_probe) {
            if (!pixel_trace) return;
            finds_ = pixel_trace->find(vertices);
            was_muted_ = pixel_trace->mute(true);
        }
    }
    ~TracedFill() {
        if constexpr (has_probe)
            if (pixel_trace) pixel_trace->mute(was_muted_);
    }
    TracedFill(const TracedFill&) = delete;
    TracedFill& operator=(const TracedFill&) = delete;

    /// Whether it is the traced pixel.
    bool holds(ivec2 pixel) const { return finds_ && pixel == pixel_trace->pixel(); }

  private:
    bool finds_ = false, was_muted_ = false;
};

/// While there is one of these, a fragment is drawn, or several that follow each other in a row.
class TracedFragment {
  public:
    TracedFragment(const TracedFill& fill, ivec2 pixel) {
        if constexpr (has_probe) begin(fill.holds(pixel), 0);
    }

    /// @param covered  Called as covered(i): whether the triangle covers the pixel that lies i to
    ///                 the right of the first one.
    template <typename Covered>
    TracedFragment(const TracedFill& fill, ivec2 first, int count, const Covered& covered) {
        if constexpr (has_probe)
            for (int i = 0; i < count; ++i)
                if (fill.holds(first + ivec2(i, 0)) && covered(i)) begin(true, i);
    }
    ~TracedFragment() {
        if constexpr (has_probe)
            if (is_traced_) pixel_trace->end_fragment();
    }
    TracedFragment(const TracedFragment&) = delete;
    TracedFragment& operator=(const TracedFragment&) = delete;

  private:
    void begin(bool is_traced, int lane) {
        if (!is_traced) return;
        is_traced_ = true;
        pixel_trace->lane = lane;
        pixel_trace->begin_fragment();
    }

    bool is_traced_ = false;
};

/// What is called for the pixels of a triangle, and traced in one of them.
template <typename Emit>
class TracedEmit {
  public:
    TracedEmit(const std::array<ivec2, 3>& vertices, Emit& emit) : fill_(vertices), emit_(emit) {}

    template <typename Barycentrics>
    void operator()(ivec2 pixel, const Barycentrics& at) const {
        const TracedFragment traced(fill_, pixel);
        emit_(pixel, at);
    }

  private:
    TracedFill fill_;
    Emit& emit_;
};

/// What to call for the pixels of a triangle: `emit`, which is traced in one pixel if that is asked
/// for.
///
/// @param vertices  Of the triangle on the screen.
template <typename Emit>
decltype(auto) traced(const std::array<ivec2, 3>& vertices, Emit& emit) {
    if constexpr (has_probe)
        return TracedEmit<Emit>(vertices, emit);
    else
        return (emit);
}

/// Shades what is given, which is traced in one pixel if that is asked for.
///
/// @param vertices  Of the triangle on the screen.
/// @param spans     Each of `length` pixels from `first` to the right.
/// @param shade     Called as shade(spans), perhaps several times.
template <typename Span, typename Shade>
void shade_traced(const std::array<ivec2, 3>& vertices, std::span<const Span> spans,
                  const Shade& shade) {
    if constexpr (!has_probe) {
        shade(spans);
    } else {
        if (!is_probing()) return shade(spans);
        std::vector<Span> others;
        std::optional<Span> here;
        const ivec2 pixel = pixel_trace->pixel();
        for (const Span& span : spans) {
            const int before = pixel.x - span.first.x;
            if (span.first.y != pixel.y || before < 0 || before >= span.length) {
                others.push_back(span);
                continue;
            }
            here = Span{pixel, 1};
            if (before > 0) others.push_back({span.first, before});
            if (before + 1 < span.length)
                others.push_back({pixel + ivec2(1, 0), span.length - before - 1});
        }
        if (!others.empty()) {
            const Untraced them;
            shade(std::span<const Span>(others));
        }
        if (!here) return;
        pixel_trace->lane = 0;
        pixel_trace->find_written(vertices);
        shade(std::span<const Span>(&*here, 1));
        pixel_trace->leave();
    }
}

/// Shades transparent fragments, of which one is traced if that is asked for.
///
/// @tparam Fragment  Has a `fragment` with a pixel, an opacity and a colour.
/// @param shade      Called as shade(fragments), perhaps several times.
template <typename Fragment, typename Shade>
void shade_traced(const std::array<ivec2, 3>& vertices, std::span<Fragment> fragments,
                  const Shade& shade) {
    if constexpr (!has_probe) {
        shade(fragments);
    } else {
        if (!is_probing()) return shade(fragments);
        for (Fragment& one : fragments) {
            const bool is_here = one.fragment.pixel == pixel_trace->pixel();
            const TracedFill others(vertices);
            pixel_trace->mute(!is_here);
            pixel_trace->lane = 0;
            shade(std::span<Fragment>(&one, 1));
            if (is_here) pixel_trace->blend(one.fragment.opacity, one.fragment.color);
        }
    }
}

}  // namespace rasterbook
