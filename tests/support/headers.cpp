// SPDX-License-Identifier: MIT
// No test: the program that this file makes only holds the tests' precompiled header.
