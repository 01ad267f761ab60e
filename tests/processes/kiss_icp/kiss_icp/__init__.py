# SPDX-License-Identifier: Apache-2.0
"""A stand-in with the interface of the public KISS-ICP (1.x), so that the guide's script can be tried without it."""
