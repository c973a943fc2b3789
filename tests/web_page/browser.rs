//! A headless Chromium, driven over its debugging pipe.

use std::{
    collections::VecDeque,
    io::{BufRead, BufReader, Read, Write},
    path::PathBuf,
    process::{Child, ChildStdin, Command, Stdio},
    sync::{
        atomic::{AtomicU32, Ordering},
        mpsc::{Receiver, channel},
    },
    thread,
    time::{Duration, Instant},
};

use serde_json::{Value, json};

/// Longer than anything takes on a slow machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Its own software adapter, also for putting the page together: canvases would stay black otherwise.
const SOFTWARE_WEBGPU: [&str; 8] = [
    "--enable-unsafe-webgpu",
    "--enable-features=Vulkan",
    "--use-angle=swiftshader",
    "--use-vulkan=swiftshader",
    "--disable-vulkan-surface",
    "--ignore-gpu-blocklist",
    "--use-webgpu-adapter=swiftshader",
    "--enable-unsafe-swiftshader",
];

/// What the page can draw with.
#[derive(Clone, Copy)]
pub enum Adapter {
    Software,
    None,
}

/// A browser with one page.
pub struct Browser {
    process: Child,
    commands: ChildStdin,
    answers: Receiver<Value>,
    session: Option<Value>,
    sent: u64,
    unread: VecDeque<Value>,
    /// What the page's console and the browser complained of.
    pub complaints: Vec<String>,
    /// The browser's own files.
    profile: PathBuf,
}

impl Browser {
    pub fn open(adapter: Adapter) -> Self {
        static OPENED: AtomicU32 = AtomicU32::new(0);
        let number = OPENED.fetch_add(1, Ordering::Relaxed);
        let name = format!("globefill-page-{}-{number}", std::process::id());
        let profile = std::env::temp_dir().join(name);
        let flags: &[&str] = match adapter {
            Adapter::Software => &SOFTWARE_WEBGPU,
            Adapter::None => &["--disable-gpu", "--disable-features=WebGPU"],
        };
        let program = std::env::var("CHROMIUM").unwrap_or_else(|_| "chromium".into());
        // The pipe is two descriptors, 3 and 4; the shell makes them of what a child can be given.
        let mut process = Command::new("sh")
            .args(["-c", "exec \"$@\" 3<&0 4>&1 1>&2", "sh", &program])
            .args(["--headless=new", "--no-sandbox", "--remote-debugging-pipe"])
            .args(["--window-size=1280,820", "--hide-scrollbars"])
            .arg(format!("--user-data-dir={}", profile.display()))
            .args(flags)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Chromium, or what CHROMIUM names");
        let commands = process.stdin.take().unwrap();
        let mut pipe = BufReader::new(process.stdout.take().unwrap());
        let (sender, answers) = channel();
        thread::spawn(move || {
            let mut message = Vec::new();
            while pipe
                .read_until(0, &mut message)
                .is_ok_and(|bytes| bytes > 0)
            {
                message.pop();
                if sender
                    .send(serde_json::from_slice(&message).unwrap())
                    .is_err()
                {
                    return;
                }
                message.clear();
            }
        });
        let mut browser = Self {
            process,
            commands,
            answers,
            session: None,
            sent: 0,
            unread: VecDeque::new(),
            complaints: Vec::new(),
            profile,
        };
        browser.attach();
        browser
    }

    fn attach(&mut self) {
        let downloads = self.downloads();
        std::fs::create_dir_all(&downloads).unwrap();
        self.call(
            "Browser.setDownloadBehavior",
            json!({ "behavior": "allow", "downloadPath": downloads }),
        );
        let page = self.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attached = self.call(
            "Target.attachToTarget",
            json!({ "targetId": page["targetId"], "flatten": true }),
        );
        self.session = Some(attached["sessionId"].clone());
        for domain in ["Runtime.enable", "Log.enable", "Page.enable", "DOM.enable"] {
            self.call(domain, json!({}));
        }
        self.call(
            "Page.setInterceptFileChooserDialog",
            json!({ "enabled": true }),
        );
    }

    /// Where downloads go.
    pub fn downloads(&self) -> PathBuf {
        self.profile.join("downloads")
    }

    /// Sends a command, and waits for its answer.
    pub fn call(&mut self, method: &str, params: Value) -> Value {
        self.sent += 1;
        let mut command = json!({ "id": self.sent, "method": method, "params": params });
        if let Some(session) = &self.session {
            command["sessionId"] = session.clone();
        }
        let mut bytes = serde_json::to_vec(&command).unwrap();
        bytes.push(0);
        self.commands.write_all(&bytes).unwrap();
        let until = Instant::now() + PATIENCE;
        loop {
            let mut message = self
                .receive(until)
                .unwrap_or_else(|| panic!("{method} was not answered"));
            if message["id"] == self.sent {
                assert!(message["error"].is_null(), "{method}: {}", message["error"]);
                return message["result"].take();
            }
            self.unread.push_back(message);
        }
    }

    /// The next event for which `wanted` finds something.
    pub fn wait<T>(&mut self, what: &str, mut wanted: impl FnMut(&Value) -> Option<T>) -> T {
        let until = Instant::now() + PATIENCE;
        let mut last = Value::Null;
        loop {
            let message = match self.unread.pop_front() {
                Some(message) => message,
                None => self.receive(until).unwrap_or_else(|| {
                    panic!("{what} did not come; last: {last}; {:?}", self.complaints)
                }),
            };
            if let Some(found) = wanted(&message) {
                return found;
            }
            last = message;
        }
    }

    /// Waits for a line that the viewer logs, of words `name=value`, which has all of these.
    pub fn wait_for_line(&mut self, words: &[&str]) -> String {
        self.wait(&format!("a line with {words:?}"), |message| {
            let line = console_line(message, "log")?;
            let has = |word: &&str| line.split(' ').any(|it| it == *word);
            words.iter().all(has).then_some(line)
        })
    }

    fn receive(&mut self, until: Instant) -> Option<Value> {
        let left = until.saturating_duration_since(Instant::now());
        let message = self.answers.recv_timeout(left).ok()?;
        let is_bad = |level: &Value| level == "error" || level == "warning";
        let entry = &message["params"]["entry"];
        if message["method"] == "Runtime.exceptionThrown"
            || console_line(&message, "error").is_some()
            || console_line(&message, "warning").is_some()
            || is_bad(&entry["level"])
        {
            self.complaints.push(message["params"].to_string());
        }
        Some(message)
    }

    /// The value of a JavaScript expression, awaited.
    pub fn evaluate(&mut self, expression: &str) -> Value {
        let params =
            json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let mut answer = self.call("Runtime.evaluate", params);
        assert!(
            answer["exceptionDetails"].is_null(),
            "{expression}: {answer}"
        );
        answer["result"]["value"].take()
    }

    pub fn mouse(&mut self, kind: &str, x: f64, y: f64, more: Value) {
        let mut params = json!({ "type": kind, "x": x, "y": y });
        for (name, value) in more.as_object().into_iter().flatten() {
            params[name] = value.clone();
        }
        self.call("Input.dispatchMouseEvent", params);
    }

    /// Moves there, rests until the page has seen that, and clicks.
    pub fn click(&mut self, x: f64, y: f64) {
        self.mouse("mouseMoved", x, y, json!({}));
        self.frames(2);
        let left = json!({ "button": "left", "clickCount": 1 });
        self.mouse("mousePressed", x, y, left.clone());
        // At once: what takes a software adapter a second to draw is no click.
        // What was seen so far was not caused by this.
        self.unread.clear();
        self.mouse("mouseReleased", x, y, left);
        self.frames(2);
    }

    /// Lets the page draw.
    pub fn frames(&mut self, count: u32) {
        self.evaluate(&format!(
            "(async () => {{ for (let i = 0; i < {count}; i++) await new Promise(requestAnimationFrame) }})()"
        ));
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
        let _ = std::fs::remove_dir_all(&self.profile);
    }
}

/// The text of a message of the console at a level.
fn console_line(message: &Value, level: &str) -> Option<String> {
    let params = &message["params"];
    let is_it = message["method"] == "Runtime.consoleAPICalled" && params["type"] == level;
    is_it.then(|| {
        params["args"][0]["value"]
            .as_str()
            .unwrap_or_default()
            .to_owned()
    })
}

/// Serves a folder on a free port of this machine.
pub struct Server {
    process: Child,
    pub port: u16,
}

impl Server {
    pub fn start(folder: &str) -> Self {
        let mut process = Command::new("python3")
            .args([
                "-u",
                "-m",
                "http.server",
                "0",
                "--bind",
                "127.0.0.1",
                "--directory",
                folder,
            ])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("python3");
        // Serving HTTP on 127.0.0.1 port 41234 (…
        let mut line = String::new();
        let mut output = BufReader::new(process.stdout.take().unwrap());
        output.read_line(&mut line).unwrap();
        thread::spawn(move || output.read_to_end(&mut Vec::new()));
        let port = line.split(' ').skip_while(|word| *word != "port").nth(1);
        let port = port
            .and_then(|port| port.parse().ok())
            .expect("the server's port");
        Self { process, port }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
