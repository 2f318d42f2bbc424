// Compiles a job by a Flamenco job type in the interpreter that Flamenco Manager embeds: compile_job SCRIPT JOB.json
//
// Prints the tasks as JSON. What a script finds in the Manager stands here as far as that of Firetwin asks for it.
package main

import (
	"encoding/json"
	"errors"
	"fmt"
	"os"
	"strconv"
	"strings"

	"github.com/dop251/goja"
)

// Command is what a worker does.
type Command struct {
	Name       string
	Parameters map[string]any
}

// Task is what a worker gets; Before has the names of those that it waits for.
type Task struct {
	Name, Type string
	Commands   []Command
	Before     []string
}

// AddCommand is called by scripts.
func (t *Task) AddCommand(c *Command) { t.Commands = append(t.Commands, *c) }

// AddDependency is called by scripts.
func (t *Task) AddDependency(other *Task) { t.Before = append(t.Before, other.Name) }

// Job is what was submitted.
type Job struct {
	Name     string
	Settings map[string]any
	tasks    []*Task
}

// AddTask is called by scripts.
func (j *Job) AddTask(t *Task) { j.tasks = append(j.tasks, t) }

// split gives the frames of a list such as "3,5-7" in chunks of one.
func split(frames string, size int) ([]string, error) {
	if size != 1 {
		return nil, errors.New("only chunks of one frame here")
	}
	var found []string
	for _, part := range strings.Split(frames, ",") {
		low, high, isRange := strings.Cut(strings.TrimSpace(part), "-")
		if !isRange {
			high = low
		}
		first, wrong := strconv.Atoi(low)
		last, alsoWrong := strconv.Atoi(high)
		if err := errors.Join(wrong, alsoWrong); err != nil {
			return nil, err
		}
		for frame := first; frame <= last; frame++ {
			found = append(found, strconv.Itoa(frame))
		}
	}
	return found, nil
}

func compile(script, job string) ([]*Task, error) {
	text, err := os.ReadFile(script)
	if err != nil {
		return nil, err
	}
	submitted, err := os.ReadFile(job)
	if err != nil {
		return nil, err
	}
	asked := &Job{}
	if err := json.Unmarshal(submitted, asked); err != nil {
		return nil, err
	}
	vm := goja.New()
	vm.SetFieldNameMapper(goja.UncapFieldNameMapper())
	vm.Set("print", fmt.Println)
	vm.Set("frameChunker", split)
	vm.Set("author", map[string]any{
		"Task": func(name, kind string) *Task { return &Task{Name: name, Type: kind} },
		"Command": func(name string, parameters map[string]any, steps int) *Command {
			return &Command{Name: name, Parameters: parameters}
		},
	})
	if _, err := vm.RunScript(script, string(text)); err != nil {
		return nil, err
	}
	call, isFunction := goja.AssertFunction(vm.Get("compileJob"))
	if !isFunction {
		return nil, errors.New("no function compileJob")
	}
	if _, err := call(nil, vm.ToValue(asked)); err != nil {
		return nil, err
	}
	return asked.tasks, nil
}

func main() {
	tasks, err := compile(os.Args[1], os.Args[2])
	if err == nil {
		err = json.NewEncoder(os.Stdout).Encode(tasks)
	}
	if err != nil {
		fmt.Fprintln(os.Stderr, err)
		os.Exit(1)
	}
}
