// SPDX-License-Identifier: MIT
/// @file
/// Whether AddressSanitizer or ThreadSanitizer watches the tests: all takes many times as long
/// then, and terabytes of address space are taken.
#pragma once

namespace rasterbook::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // g++
constexpr bool is_sanitized = true;
#elif defined(__has_feature)  // clang
constexpr bool is_sanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool is_sanitized = false;
#endif

}  // namespace rasterbook::test
