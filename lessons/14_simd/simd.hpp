// SPDX-License-Identifier: MIT
/// @file
/// Several numbers that take each step together: a wide number type. Introduced in lesson 14;
/// derivation: docs/derivations/14_simd.md.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "common/math/functions.hpp"

namespace rasterbook {

/// N numbers of a type T, as g++ and clang have them for any processor: `+` and the like work on
/// all of them, by as many instructions as this processor takes for N numbers.
template <typename T, int N>
struct VectorOf {
    typedef T Type __attribute__((vector_size(sizeof(T) * N)));
};
template <typename T, int N>
using Vector = typename VectorOf<T, N>::Type;

/// The elements at n places of two vectors, one behind the other: a shuffle. Up to the width of a
/// register, it takes one instruction or two.
///
/// @tparam Place  A function without captures: from an element's index, 0 to n - 1, to its place.
template <int n, typename V, typename Place>
inline auto shuffled(V a, V b, Place) {
    return [&]<int... i>(std::integer_sequence<int, i...>) {
        return __builtin_shufflevector(a, b, Place()(i)...);
    }(std::make_integer_sequence<int, n>());
}

/// Half of a vector of N elements. It stays in a register; with std::memcpy, g++ would store the
/// whole and load the half.
///
/// @tparam which  0: the first half; 1: the second one.
template <int which, int N, typename V>
inline auto half(V all) {
    return shuffled<N / 2>(all, all, [](int i) constexpr { return which * (N / 2) + i; });
}

/// How many floats a register of this processor holds. With this many lanes, the peak of Eq. 14.6
/// is highest.
#if defined(__AVX512F__)
constexpr int native_width = 16;
#elif defined(__AVX__)
constexpr int native_width = 8;
#else
constexpr int native_width = 4;
#endif

/// Whether something holds, for each of N lanes.
template <int N>
struct Mask {
    Vector<std::int32_t, N> lanes;  ///< -1 where it holds, else 0.

    bool operator[](int lane) const { return lanes[lane] != 0; }
    friend Mask operator&(Mask a, Mask b) { return {a.lanes & b.lanes}; }
    friend Mask operator|(Mask a, Mask b) { return {a.lanes | b.lanes}; }
    friend Mask operator!(Mask a) { return {~a.lanes}; }
};

/// A bit for each lane in which a mask holds.
template <int N>
inline std::uint32_t bits_of(Mask<N> mask) {
    std::uint32_t bits = 0;
    for (int i = 0; i < N; ++i) bits |= static_cast<std::uint32_t>(mask.lanes[i] & (1 << i));
    return bits;
}

template <int N>
inline bool any_of(Mask<N> mask) {
    // Halves of halves: each step is one instruction for all lanes.
    if constexpr (N == 1)
        return mask.lanes[0] != 0;
    else
        return any_of(Mask<N / 2>{half<0, N>(mask.lanes)} | Mask<N / 2>{half<1, N>(mask.lanes)});
}
template <int N>
inline bool all_of(Mask<N> mask) {
    return !any_of(!mask);
}

/// N whole numbers of 32 bits.
template <int N>
struct Ints {
    using Number = std::int32_t;
    static constexpr int width = N;
    Vector<std::int32_t, N> lanes;

    Ints() = default;
    Ints(Vector<std::int32_t, N> of_lanes) : lanes(of_lanes) {}
    explicit Ints(std::int32_t x) : lanes(x - Vector<std::int32_t, N>{}) {}

    std::int32_t operator[](int lane) const { return lanes[lane]; }
    void set(int lane, std::int32_t x) { lanes[lane] = x; }

    friend Ints operator+(Ints a, Ints b) { return {a.lanes + b.lanes}; }
    friend Ints operator-(Ints a, Ints b) { return {a.lanes - b.lanes}; }
    friend Ints operator*(Ints a, Ints b) { return {a.lanes * b.lanes}; }
    Ints& operator+=(Ints b) { return *this = *this + b; }
    friend Mask<N> operator<(Ints a, Ints b) { return {a.lanes < b.lanes}; }
    friend Mask<N> operator==(Ints a, Ints b) { return {a.lanes == b.lanes}; }
};
template <int N>
inline Ints<N> select(Mask<N> mask, Ints<N> yes, Ints<N> no) {
    return {(mask.lanes & yes.lanes) | (~mask.lanes & no.lanes)};
}

template <int N>
inline Ints<N> min(Ints<N> a, Ints<N> b) {
    return select(a < b, a, b);
}

/// The least of all numbers.
template <int N>
inline std::int32_t least_of(Ints<N> x) {
    if constexpr (N == 1)
        return x[0];
    else
        return least_of(min(Ints<N / 2>(half<0, N>(x.lanes)), Ints<N / 2>(half<1, N>(x.lanes))));
}
template <int N>
inline std::int32_t greatest_of(Ints<N> x) {
    return -least_of(Ints<N>(0) - x);
}

/// N floats: the number type F of all stages.
template <int N>
struct Floats {
    static constexpr int width = N;
    Vector<float, N> lanes;

    Floats() = default;
    Floats(Vector<float, N> of_lanes) : lanes(of_lanes) {}
    explicit Floats(float x) : lanes(x - Vector<float, N>{}) {}  // x - 0 is x, also for -0 and NaN

    float operator[](int lane) const { return lanes[lane]; }
    void set(int lane, float x) { lanes[lane] = x; }

    friend Floats operator+(Floats a, Floats b) { return {a.lanes + b.lanes}; }
    friend Floats operator-(Floats a, Floats b) { return {a.lanes - b.lanes}; }
    friend Floats operator*(Floats a, Floats b) { return {a.lanes * b.lanes}; }
    friend Floats operator/(Floats a, Floats b) { return {a.lanes / b.lanes}; }
    Floats operator-() const { return {-lanes}; }
    Floats& operator+=(Floats b) { return *this = *this + b; }
    Floats& operator-=(Floats b) { return *this = *this - b; }
    Floats& operator*=(Floats b) { return *this = *this * b; }

    friend Mask<N> operator<(Floats a, Floats b) { return {a.lanes < b.lanes}; }
    friend Mask<N> operator>(Floats a, Floats b) { return {a.lanes > b.lanes}; }
    friend Mask<N> operator<=(Floats a, Floats b) { return {a.lanes <= b.lanes}; }
    friend Mask<N> operator>=(Floats a, Floats b) { return {a.lanes >= b.lanes}; }
    friend Mask<N> operator==(Floats a, Floats b) { return {a.lanes == b.lanes}; }
};

/// `yes` in the lanes where the mask holds, else `no` (Eq. 14.1).
template <int N>
inline Floats<N> select(Mask<N> mask, Floats<N> yes, Floats<N> no) {
    using Bits = Vector<std::int32_t, N>;
    if constexpr (N <= native_width) return {mask.lanes ? yes.lanes : no.lanes};
    return {std::bit_cast<Vector<float, N>>((mask.lanes & std::bit_cast<Bits>(yes.lanes)) |
                                            (~mask.lanes & std::bit_cast<Bits>(no.lanes)))};
}

/// Some lanes get a number that they have in common; the others keep theirs.
template <int N>
inline void blend(Mask<N> lanes, Floats<N>& to, float from) {
    to = select(lanes, Floats<N>(from), to);
}
template <int n, int N>
inline void blend(Mask<N> lanes, glm::vec<n, Floats<N>>& to, const glm::vec<n, float>& from) {
    for (int i = 0; i < n; ++i) blend(lanes, to[i], from[i]);
}
template <typename To, typename From, int N>
inline void blend(Mask<N> lanes, std::array<To, 3>& to, const std::array<From, 3>& from) {
    for (std::size_t i = 0; i < 3; ++i) blend(lanes, to[i], from[i]);
}

template <int N>
inline Floats<N> sqrt(Floats<N> x) {
    for (int i = 0; i < N; ++i) x.lanes[i] = std::sqrt(x.lanes[i]);  // one instruction, optimised
    return x;
}

/// Rounded towards 0.
///
/// @param x  Below 2^31 in size; else the result may be any number.
template <int N>
inline Ints<N> truncated(Floats<N> x) {
    return {__builtin_convertvector(x.lanes, Vector<std::int32_t, N>)};
}
template <int N>
inline Floats<N> to_floats(Ints<N> x) {
    return {__builtin_convertvector(x.lanes, Vector<float, N>)};
}

/// std::floor of each number, to the bit (Eq. 14.3). From 2^23 on, all numbers are whole.
template <int N>
inline Floats<N> floor(Floats<N> x) {
    const Mask<N> is_small = (x < Floats<N>(0x1p23f)) & (x > Floats<N>(-0x1p23f));
    const Floats<N> toward_0 = to_floats(truncated(select(is_small, x, Floats<N>(0.0f))));
    const Floats<N> down =
        select(toward_0 > x, toward_0 - Floats<N>(1.0f), select(toward_0 == x, x, toward_0));
    return select(is_small, down, x);
}

template <int N>
inline FloatParts<Floats<N>> float_parts(Floats<N> x) {
    const auto bits = std::bit_cast<Vector<std::int32_t, N>>(x.lanes);
    return {{std::bit_cast<Vector<float, N>>((bits & 0x007fffff) | 0x3f800000)},
            to_floats(Ints<N>((bits >> 23) - 127))};
}

template <int N>
inline Floats<N> two_to_the(Floats<N> n) {
    return {std::bit_cast<Vector<float, N>>((truncated(n).lanes + 127) << 23)};
}

/// N doubles, in two halves: each fits into a register if N floats do. Wider vectors are kept in
/// memory by g++.
template <int N>
struct Doubles {
    using Number = double;
    static constexpr int width = N;
    using Half = Vector<double, N / 2>;
    Half low, high;

    Doubles() = default;
    Doubles(Half of_low, Half of_high) : low(of_low), high(of_high) {}
    explicit Doubles(double x) : low(x - Half{}), high(low) {}
    explicit Doubles(Ints<N> x)
        : low(__builtin_convertvector(half<0, N>(x.lanes), Half)),
          high(__builtin_convertvector(half<1, N>(x.lanes), Half)) {}

    double operator[](int lane) const { return lane < N / 2 ? low[lane] : high[lane - N / 2]; }

    friend Doubles operator+(Doubles a, Doubles b) { return {a.low + b.low, a.high + b.high}; }
    friend Doubles operator*(Doubles a, Doubles b) { return {a.low * b.low, a.high * b.high}; }
    Doubles& operator+=(Doubles b) { return *this = *this + b; }
};
template <int N>
inline Floats<N> to_floats(Doubles<N> x) {
    using Half = Vector<float, N / 2>;
    return {shuffled<N>(__builtin_convertvector(x.low, Half), __builtin_convertvector(x.high, Half),
                        [](int i) constexpr { return i; })};
}

/// The numbers 0, 1, 2 ...
template <int N>
inline Ints<N> lane_numbers() {
    Ints<N> numbers;
    for (int i = 0; i < N; ++i) numbers.set(i, i);
    return numbers;
}

// What code for any number type F, float as well, asks of it:

/// How many numbers an F holds.
template <typename F>
constexpr int width_of = sizeof(F) / sizeof(float);

/// What a comparison of two F gives: bool, or a Mask.
template <typename F>
using MaskOf = decltype(F() < F());

/// F numbers from an address on, whether it is a multiple of their size or not.
template <typename F>
inline F load(const float* from) {
    F x;
    std::memcpy(&x, from, sizeof x);
    return x;
}
template <typename F>
inline void store(float* to, F x) {
    std::memcpy(to, &x, sizeof x);
}

/// The first float, from number i on, for which something holds; `end` if there is none.
///
/// @param holds  Called as holds(F) and as holds(float).
template <typename F, typename Holds>
inline int first_where(const float* floats, int i, int end, Holds&& holds) {
    while (i + width_of<F> <= end && !any_of(holds(load<F>(floats + i)))) i += width_of<F>;
    while (i < end && !holds(floats[i])) ++i;
    return i;
}

/// Writes x, y and z of N points as they lie in an array of vec3: one point behind the other.
template <int N>
inline void store(vec3* to, const Vec3<Floats<N>>& points) {
    const auto write = [&]<int part>(std::integral_constant<int, part>) {  // N of the 3 N floats
        const auto xy = shuffled<N>(points.x.lanes, points.y.lanes, [](int i) constexpr {
            const int place = part * N + i;
            return place / 3 + (place % 3 == 1 ? N : 0);
        });
        const auto xyz = shuffled<N>(xy, points.z.lanes, [](int i) constexpr {
            const int place = part * N + i;
            return place % 3 == 2 ? N + place / 3 : i;
        });
        std::memcpy(reinterpret_cast<float*>(to) + part * N, &xyz, sizeof xyz);
    };
    write(std::integral_constant<int, 0>());
    write(std::integral_constant<int, 1>());
    write(std::integral_constant<int, 2>());
}

/// Writes a point `count` times, one behind the other: as many at once as F has numbers.
template <typename F>
inline void fill(vec3* to, int count, vec3 point) {
    if constexpr (width_of<F> > 1)
        for (; count >= width_of<F>; to += width_of<F>, count -= width_of<F>)
            store(to, Vec3<F>(point));
    std::fill_n(to, count, point);
}

/// Writes a number where the mask holds.
inline void write_where(bool mask, std::uint32_t* to, std::uint32_t number) {
    if (mask) *to = number;
}
template <int N>
inline void write_where(Mask<N> mask, std::uint32_t* to, std::uint32_t number) {
    Ints<N> before;
    std::memcpy(&before, to, sizeof before);
    const Ints<N> after = select(mask, Ints<N>(static_cast<std::int32_t>(number)), before);
    std::memcpy(to, &after, sizeof after);
}

/// Whether N numbers are all at least `first` and below `end`.
template <int N>
inline bool are_within(const std::uint32_t* numbers, std::uint32_t first, std::uint32_t end) {
    Vector<std::uint32_t, N> all;
    std::memcpy(&all, numbers, sizeof all);
    return all_of(Mask<N>{all - first < end - first});
}

/// The number of one lane.
inline float lane_of(float x, int) { return x; }
template <int N>
inline float lane_of(Floats<N> x, int lane) {
    return x[lane];
}
template <typename F>
inline vec3 lane_of(const Vec3<F>& v, int lane) {
    return {lane_of(v.x, lane), lane_of(v.y, lane), lane_of(v.z, lane)};
}
inline bool lane_of(bool mask, int) { return mask; }
template <int N>
inline bool lane_of(Mask<N> mask, int lane) {
    return mask[lane];
}

template <int N>
inline void set_lane(Vec3<Floats<N>>& v, int lane, vec3 x) {
    v.x.set(lane, x.x), v.y.set(lane, x.y), v.z.set(lane, x.z);
}

/// The first lane in which a mask holds. It has to hold in one.
template <int N>
inline int first_of(Mask<N> mask) {
    return std::countr_zero(bits_of(mask));
}

/// In how many lanes a mask holds.
inline int count_of(bool mask) { return mask; }
template <int N>
inline int count_of(Mask<N> mask) {
    return std::popcount(bits_of(mask));
}

/// Counts in how many lanes masks have held, lane by lane: one step for each mask, whatever its
/// width. Up to 2^31 masks.
template <typename F>
class LaneSum {
  public:
    void add(MaskOf<F> mask) {
        if constexpr (width_of<F> == 1)
            sum_ += mask;
        else
            sum_.lanes -= mask.lanes;  // -1 where it holds
    }

    std::uint64_t total() const {
        if constexpr (width_of<F> == 1) {
            return sum_;
        } else {
            std::uint64_t total = 0;
            for (int i = 0; i < width_of<F>; ++i) total += static_cast<std::uint64_t>(sum_[i]);
            return total;
        }
    }

  private:
    std::conditional_t<width_of<F> == 1, std::uint64_t, Ints<width_of<F>>> sum_{};
};

/// A mask that holds in the first `count` lanes.
template <typename F>
inline MaskOf<F> first_lanes(int count) {
    if constexpr (width_of<F> == 1)
        return count > 0;
    else
        return lane_numbers<width_of<F>>() < Ints<width_of<F>>(count);
}

}  // namespace rasterbook

/// GLM's functions take only types that say that they are floating-point numbers.
template <int N>
struct std::numeric_limits<rasterbook::Floats<N>> : std::numeric_limits<float> {};
