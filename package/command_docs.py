#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Documents made from the program's own help.

    command_docs.py PROGRAM --share DIR        below DIR (/usr/share): man pages by help2man, completions for bash and zsh
    command_docs.py PROGRAM --markdown FILE    the command reference of docs/
"""

import argparse
import gzip
import pathlib
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass, field


@dataclass
class Option:
    names: list[str]
    value: str = ""  # as the help shows it: "FILE", "4|9|16", "INT=0"; empty for a flag
    text: str = ""

    def choices(self) -> list[str]:
        words = self.value.split("=")[0]
        return words.split("|") if "|" in words else []


@dataclass
class Command:
    name: str
    sentence: str
    help: str
    options: list[Option] = field(default_factory=list)


def help_of(program: str, *words: str) -> str:
    text = subprocess.run([program, *words, "--help"], check=True, text=True, capture_output=True).stdout
    return text.replace(f"Usage: {program}", "Usage: sheen")


def read_options(text: str) -> list[Option]:
    """The entries below "Options:": names and value at column 2, what they do from column 30 on."""
    options: list[Option] = []
    for line in text.split("\nOptions:\n")[1].split("\n\n")[0].splitlines():
        if line.startswith("  -"):
            head, _, rest = line[2:].partition("  ")
            words = head.removesuffix(" REQUIRED").split(" ", 1)
            options.append(Option(words[0].split(","), words[1] if len(words) > 1 else "", rest.strip()))
        elif options:
            options[-1].text = f"{options[-1].text} {line.strip()}".strip()
    return options


def read_commands(program: str) -> list[Command]:
    listed = help_of(program).split("\nSubcommands:\n")[1].split("\n\n")[0]
    commands = []
    for name, sentence in re.findall(r"^  (\S+)\s+(.*)$", listed, re.MULTILINE):
        text = help_of(program, name)
        commands.append(Command(name, sentence, text, read_options(text)))
    return commands


def write_man_pages(program: str, commands: list[Command], folder: pathlib.Path) -> None:
    if not shutil.which("help2man"):
        print("command_docs.py: no man pages: install the package help2man", file=sys.stderr)
        return
    folder.mkdir(parents=True, exist_ok=True)
    version = subprocess.run([program, "--version"], check=True, text=True, capture_output=True).stdout.split()[1]
    pages = {"sheen": ("", "surface light fields from a walk round an object")}
    pages |= {f"sheen-{command.name}": (command.name, command.sentence) for command in commands}
    for page, (word, sentence) in pages.items():
        roff = subprocess.run(
            ["help2man", "--no-info", f"--name={sentence}", f"--version-string={version}", f"{program} {word}".strip()],
            check=True, text=True, capture_output=True).stdout
        roff = re.sub(r'^\.TH .*$', f'.TH {page.upper()} 1 "" "Sheen {version}" "User Commands"', roff, flags=re.MULTILINE)
        roff = re.sub(r"^(\.SH NAME\n).*? \\-", rf"\1{page} \\-", roff, flags=re.MULTILINE)
        (folder / f"{page}.1.gz").write_bytes(gzip.compress(roff.encode(), mtime=0))


def bash_completion(commands: list[Command]) -> str:
    cases, choices = [], []
    for command in commands:
        names = " ".join(name for option in command.options for name in option.names)
        cases.append(f'    {command.name}) options="{names}" ;;')
        for option in command.options:
            if option.choices():
                pattern = "|".join(f"{command.name}:{name}" for name in option.names)
                choices.append(f'    {pattern}) words="{" ".join(option.choices())}" ;;')
    names = " ".join(command.name for command in commands)
    return "\n".join([
        "# bash completion of sheen", "_sheen() {", "  local current=${COMP_WORDS[COMP_CWORD]} options= words=",
        "  if ((COMP_CWORD == 1)); then", f'    COMPREPLY=($(compgen -W "{names} --help --version" -- "$current"))',
        "    return", "  fi", "  case ${COMP_WORDS[1]}:${COMP_WORDS[COMP_CWORD - 1]} in", *choices, "  esac",
        "  case ${COMP_WORDS[1]} in", *cases, "  esac", "  if [[ -z $words && $current == -* ]]; then words=$options; fi",
        "  # Other arguments are files: readline's default.",
        '  COMPREPLY=($([[ -z $words ]] || compgen -W "$words" -- "$current"))', "}",
        "complete -o default -F _sheen sheen", ""])


def zsh_completion(commands: list[Command]) -> str:
    def quoted(text: str) -> str:
        return re.sub(r"([\[\]:\\])", r"\\\1", text).replace("'", "'\\''")

    lines = ["#compdef sheen", "local -a commands=("]
    lines += [f"  '{command.name}:{quoted(command.sentence)}'" for command in commands]
    lines += [")", "if ((CURRENT == 2)); then", "  _describe command commands", "  return", "fi", "case $words[2] in"]
    for command in commands:
        lines.append(f"  {command.name}) _arguments \\")
        for option in command.options:
            for name in option.names:
                action = f"({' '.join(option.choices())})" if option.choices() else "_files"
                value = f":{quoted(option.value.split('=')[0].lower())}:{action}" if option.value else ""
                lines.append(f"    '{name}[{quoted(option.text)}]{value}' \\")
        lines.append("    '*:file:_files' ;;")
    return "\n".join(lines + ["esac", ""])


def markdown(program: str, commands: list[Command]) -> str:
    parts = ["# Commands", "Made from the program's help by `package/command_docs.py build/sheen --markdown docs/commands.md`.",
             "```\n" + help_of(program).strip() + "\n```"]
    for command in commands:
        parts += [f"## sheen {command.name}", "```\n" + command.help.strip() + "\n```"]
    return "\n\n".join(parts) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--share", type=pathlib.Path)
    parser.add_argument("--markdown", type=pathlib.Path)
    wanted = parser.parse_args()
    commands = read_commands(wanted.program)
    if wanted.share:
        write_man_pages(wanted.program, commands, wanted.share / "man/man1")
        for path, text in (("bash-completion/completions/sheen", bash_completion(commands)),
                           ("zsh/vendor-completions/_sheen", zsh_completion(commands))):
            (wanted.share / path).parent.mkdir(parents=True, exist_ok=True)
            (wanted.share / path).write_text(text)
    if wanted.markdown:
        wanted.markdown.write_text(markdown(wanted.program, commands))


if __name__ == "__main__":
    main()
