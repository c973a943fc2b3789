//! Prints the graphics adapter that wgpu would use; exits with 1 if there is none.

fn main() {
    let instance = wgpu::Instance::default();
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()));
    match adapter {
        Ok(adapter) => {
            let info = adapter.get_info();
            println!("Adapter: {} ({:?})", info.name, info.backend);
        }
        Err(error) => {
            eprintln!("No adapter: {error}");
            std::process::exit(1);
        }
    }
}
